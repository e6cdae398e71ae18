#include "fusion-server/site/ownership.h"

#include <gtest/gtest.h>

namespace chorus::site {
namespace {

using std::chrono::milliseconds;

const CellId kUs = *SensorId::parse("us");
const CellId kThem = *SensorId::parse("them");
const SiteId kPerson = *SiteId::parse("p-1");
constexpr Timestamp kBegin = from_unix_ns(1'795'000'000'000'000'000);

OwnSight sight(double ours, std::optional<double> theirs, bool theirs_see = true) {
  OwnSight all{kPerson, ours * ours, true, true, {}};
  if (theirs) all.others.push_back({kThem, *theirs * *theirs, theirs_see});
  return all;
}

Claim held_by(const CellId& cell, std::uint64_t revision) {
  return {kPerson, cell, revision, ClaimState::Held, {}};
}

/// Looks 30 times a second for `length`; the requests.
std::vector<ClaimRequest> watch(Ownership& ownership, const OwnSight& seen, Timestamp from,
                                Duration length) {
  std::vector<ClaimRequest> all;
  for (Timestamp now = from; now <= from + length; now += milliseconds(33)) {
    const auto wanted = ownership.wanted({&seen, 1}, now);
    all.insert(all.end(), wanted.begin(), wanted.end());
  }
  return all;
}

TEST(Ownership, IsClaimedByWhoSeesSomebodyAlone) {
  Ownership ownership(kUs, {});
  const auto wanted = watch(ownership, sight(0.02, {}), kBegin, Duration{0});
  ASSERT_EQ(wanted.size(), 1U);
  EXPECT_EQ(wanted[0].expected, 0U);
  EXPECT_EQ(wanted[0].value.cell, kUs);
}

TEST(Ownership, GoesOverWhenOursHasBeenTheSmallerErrorForHalfASecond) {
  Ownership ownership(kUs, {});
  ownership.take(held_by(kThem, 7), kBegin);
  EXPECT_TRUE(watch(ownership, sight(0.02, 0.05), kBegin, milliseconds(450)).empty());
  EXPECT_EQ(ownership.answers(sight(0.02, 0.05)), kThem);
  const auto wanted =
      watch(ownership, sight(0.02, 0.05), kBegin + milliseconds(460), milliseconds(100));
  ASSERT_EQ(wanted.size(), 1U);
  EXPECT_EQ(wanted[0].expected, 7U);
  ownership.take(ClaimResult{held_by(kUs, 8), true}, kBegin + milliseconds(600));
  EXPECT_EQ(ownership.answers(sight(0.02, 0.05)), kUs);
}

TEST(Ownership, StaysWhereErrorsAreAlikeOrTheirsIsSmaller) {
  for (const double ours : {0.05, 0.048, 0.08}) {
    Ownership ownership(kUs, {});
    ownership.take(held_by(kThem, 7), kBegin);
    EXPECT_TRUE(watch(ownership, sight(ours, 0.05), kBegin, std::chrono::seconds(5)).empty())
        << ours;
  }
}

TEST(Ownership, ComesFromAHolderWhoHasLostSightAtOnce) {
  for (const OwnSight& seen : {sight(0.08, {}), sight(0.08, 0.02, false)}) {
    Ownership ownership(kUs, {});
    ownership.take(held_by(kThem, 7), kBegin);
    EXPECT_FALSE(watch(ownership, seen, kBegin, milliseconds(400)).empty());
  }
}

TEST(Ownership, IsNotTakenWhereAnotherCellWasFaster) {
  Ownership ownership(kUs, {});
  ownership.take(held_by(kThem, 7), kBegin);
  (void)watch(ownership, sight(0.02, 0.05), kBegin, milliseconds(600));
  const CellId third = *SensorId::parse("third");
  ownership.take(ClaimResult{held_by(third, 8), false}, kBegin + milliseconds(610));
  EXPECT_EQ(ownership.holder(kPerson), third);
  // An older record that comes late changes nothing.
  ownership.take(held_by(kThem, 7), kBegin + milliseconds(620));
  EXPECT_EQ(ownership.holder(kPerson), third);
}

TEST(Ownership, IsAskedForAgainWhenTheStoreDoesNotAnswer) {
  Ownership ownership(kUs, {});
  const auto wanted = watch(ownership, sight(0.02, {}), kBegin, milliseconds(2500));
  EXPECT_EQ(wanted.size(), 3U);
}

TEST(Ownership, OfSomebodyWhoIsGoneIsReleased) {
  Ownership ownership(kUs, {});
  const OwnSight seen = sight(0.02, {});
  (void)ownership.wanted({&seen, 1}, kBegin);
  ownership.take(ClaimResult{held_by(kUs, 1), true}, kBegin);
  EXPECT_TRUE(ownership.wanted({}, kBegin + std::chrono::seconds(1)).empty());
  const auto wanted = ownership.wanted({}, kBegin + std::chrono::seconds(3));
  ASSERT_EQ(wanted.size(), 1U);
  EXPECT_EQ(wanted[0].value.state, ClaimState::Released);
}

TEST(Ownership, OfADoubtfulNameIsNotClaimed) {
  Ownership ownership(kUs, {});
  OwnSight seen = sight(0.02, {});
  seen.sure = false;
  EXPECT_TRUE(watch(ownership, seen, kBegin, std::chrono::seconds(3)).empty());
}

TEST(Ownership, IsAskedForAsNewWhenTheStoreHasForgottenTheRecord) {
  Ownership ownership(kUs, {});
  ownership.take(held_by(kThem, 7), kBegin);
  const auto stale = watch(ownership, sight(0.08, {}), kBegin, milliseconds(400));
  ASSERT_EQ(stale.size(), 1U);
  EXPECT_EQ(stale[0].expected, 7U);
  Claim none = stale[0].value;
  none.revision = 0;
  ownership.take(ClaimResult{none, false}, kBegin + milliseconds(410));
  EXPECT_FALSE(ownership.holder(kPerson));
  const auto wanted =
      watch(ownership, sight(0.08, {}), kBegin + milliseconds(420), milliseconds(100));
  ASSERT_EQ(wanted.size(), 1U);
  EXPECT_EQ(wanted[0].expected, 0U);
}

TEST(Ownership, OfPeopleNobodyTellsOfIsNotKeptWithoutBound) {
  Ownership ownership(kUs, {});
  const OwnSight seen = sight(0.02, {});
  (void)ownership.wanted({&seen, 1}, kBegin);
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const SiteId invented = *SiteId::parse("i-" + std::to_string(i));
    ownership.take(Claim{invented, kThem, i + 1, ClaimState::Held, {}}, kBegin);
  }
  EXPECT_FALSE(ownership.holder(*SiteId::parse("i-19999")));
  ownership.take(held_by(kThem, 30'000), kBegin);
  EXPECT_EQ(ownership.holder(kPerson), kThem) << "one of our people";
}

TEST(Ownership, RecordsAJoinedIdUntilTheStoreHasIt) {
  Ownership ownership(kUs, {});
  const SiteId kept = *SiteId::parse("a-1");
  ownership.join(kept, kPerson);
  const auto wanted = ownership.wanted({}, kBegin);
  ASSERT_EQ(wanted.size(), 1U);
  EXPECT_EQ(wanted[0].value.state, ClaimState::Joined);
  EXPECT_EQ(wanted[0].value.same_as, kept);
  ownership.take(Claim{kPerson, kUs, 2, ClaimState::Joined, kept}, kBegin);
  EXPECT_TRUE(ownership.wanted({}, kBegin + std::chrono::seconds(5)).empty());
}

}  // namespace
}  // namespace chorus::site

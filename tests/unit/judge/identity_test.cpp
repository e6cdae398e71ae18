#include "tests/judge/identity.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/judge/person_builder.h"

namespace chorus::bench {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Two people a metre apart for `count` instants; the method reports them with ids 1 and 2.
std::vector<Roll> two_people(int count) {
  std::vector<Roll> rolls;
  for (int i = 0; i < count; ++i) {
    rolls.push_back({at_frame(i), {{1, {0.1, 0}}, {2, {1.1, 0}}}, {{0, 0}, {1, 0}}});
  }
  return rolls;
}

TEST(Identity, OfFaithfulTracksIsPerfect) {
  const Identity found = identity_of(two_people(101));
  EXPECT_EQ(found.switches, 0u);
  EXPECT_EQ(found.fragmentations, 0u);
  EXPECT_EQ(found.ghosts, 0u);
  EXPECT_DOUBLE_EQ(found.coverage, 1.0);
  EXPECT_DOUBLE_EQ(found.idf1, 1.0);
  EXPECT_NEAR(found.minutes, 4.0 / 60, 1e-12);
}

TEST(Identity, TellsTheLongestFalseSpellAndTheLongestGap) {
  auto rolls = two_people(100);
  for (std::size_t i = 10; i < 40; ++i) rolls[i].claimed.push_back({7, {5.0, 0.0}});
  rolls[25].claimed.pop_back();  // two spells of 15 and 14 instants
  for (std::size_t i = 50; i < 60; ++i) rolls[i].claimed.pop_back();
  const Identity found = identity_of(rolls);
  const double instant = 60.0 * found.minutes / 99.0;
  EXPECT_NEAR(found.longest_false, 14 * instant, 1e-9);
  EXPECT_NEAR(found.longest_unseen, 9 * instant, 1e-9);
}

TEST(Identity, ExchangedIdsAreASwitchOfEach) {
  auto rolls = two_people(100);
  for (std::size_t i = 75; i < 100; ++i) std::swap(rolls[i].claimed[0].id, rolls[i].claimed[1].id);
  const Identity found = identity_of(rolls);
  EXPECT_EQ(found.switches, 2u);
  EXPECT_EQ(found.fragmentations, 0u);
  EXPECT_DOUBLE_EQ(found.coverage, 1.0);
  EXPECT_NEAR(found.idf1, 0.75, 1e-12);
}

TEST(Identity, AGapIsAFragmentationAndANewIdAfterItASwitchToo) {
  auto rolls = two_people(100);
  for (std::size_t i = 40; i < 50; ++i) rolls[i].claimed.pop_back();
  EXPECT_EQ(identity_of(rolls).fragmentations, 1u);
  EXPECT_EQ(identity_of(rolls).switches, 0u);
  EXPECT_NEAR(identity_of(rolls).coverage, 0.95, 1e-12);
  for (std::size_t i = 50; i < 100; ++i) rolls[i].claimed[1].id = 3;
  EXPECT_EQ(identity_of(rolls).fragmentations, 1u);
  EXPECT_EQ(identity_of(rolls).switches, 1u);
}

TEST(Identity, ATrackThatFollowsNobodyIsAGhost) {
  auto rolls = two_people(100);
  for (std::size_t i = 0; i < 10; ++i) rolls[i].claimed.push_back({9, {5, 5}});
  const Identity found = identity_of(rolls);
  EXPECT_EQ(found.ghosts, 1u);
  EXPECT_NEAR(found.idf1, 400.0 / (200 + 210), 1e-12);
}

TEST(Identity, AnAnswerOutOfReachIsNotThatPerson) {
  auto rolls = two_people(10);
  for (Roll& roll : rolls) roll.claimed[1].place.x() = 1.6;
  EXPECT_NEAR(identity_of(rolls).coverage, 0.5, 1e-12);
  EXPECT_EQ(identity_of(rolls).ghosts, 1u);
}

TEST(Identity, ACloserStrangerDoesNotTakeAFollowedPersonAway) {
  auto rolls = two_people(10);
  for (std::size_t i = 5; i < 10; ++i) rolls[i].claimed.push_back({9, {0, 0}});
  EXPECT_EQ(identity_of(rolls).switches, 0u);
  EXPECT_EQ(identity_of(rolls).ghosts, 1u);
}

TEST(Identity, TheFirstAnswerCountsFromWhenSomebodyIsThere) {
  EXPECT_DOUBLE_EQ(identity_of(two_people(50)).first_answer, 0.0);
  auto rolls = two_people(50);
  for (std::size_t i = 0; i < 10; ++i) rolls[i].exact[1] = {kNan, kNan};
  for (std::size_t i = 0; i < 15; ++i) rolls[i].claimed.pop_back();
  const double late = seconds(rolls[15].instant - rolls[10].instant);
  EXPECT_NEAR(identity_of(rolls).first_answer, late / 2, 1e-9);
}

TEST(Identity, SomebodyWhoIsNotInTheRoomNeedsNoAnswer) {
  auto rolls = two_people(10);
  for (Roll& roll : rolls) roll.exact.push_back({kNan, kNan});
  EXPECT_DOUBLE_EQ(identity_of(rolls).coverage, 1.0);
  EXPECT_DOUBLE_EQ(identity_of(rolls).idf1, 1.0);
}

TEST(Identity, OfNothingIsZero) {
  EXPECT_EQ(identity_of({}).idf1, 0.0);
  EXPECT_EQ(identity_of({}).coverage, 0.0);
}

TEST(Identity, AnIdThatFollowsTwoPeopleForASecondEachIsInherited) {
  auto rolls = two_people(101);
  for (std::size_t i = 0; i < rolls.size(); ++i) {
    rolls[i].claimed.pop_back();
    rolls[i].exact[i < 50 ? 1 : 0].setConstant(kNan);
    if (i >= 50) rolls[i].claimed[0].place = {1, 0};
  }
  EXPECT_EQ(identity_of(rolls).inherited, 1u);
  for (std::size_t i = 50; i < 80; ++i) rolls[i].claimed[0].id = 2;
  EXPECT_EQ(identity_of(rolls).inherited, 0u) << "21 instants, and a second has 25";
  IdentityConfig strict;
  strict.lasting = 0.5;
  EXPECT_EQ(identity_of(rolls, strict).inherited, 1u);
}

TEST(Identity, ANewIdOfSomebodyWhoHadOneIsSpare) {
  auto rolls = two_people(100);
  EXPECT_EQ(identity_of(rolls).spare_ids, 0u);
  for (std::size_t i = 50; i < 100; ++i) rolls[i].claimed[1].id = 3;
  EXPECT_EQ(identity_of(rolls).spare_ids, 1u);
  EXPECT_EQ(identity_of(rolls).inherited, 0u);
}

}  // namespace
}  // namespace chorus::bench

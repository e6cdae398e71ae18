#include "fusion-server/journal/roll.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::journal {
namespace {

using testing::kStart;
using testing::sensor_id;

FusedBody body(std::uint64_t id, std::uint64_t contributors = 1) {
  FusedBody one;
  one.id = {id};
  one.slot = id;
  one.contributors.fill(0);
  one.contributors[3] = contributors;
  return one;
}

Snapshot snapshot(Duration after, std::vector<FusedBody> bodies) {
  Snapshot s;
  s.instant = kStart + after;
  s.sensors = {sensor_id("s1"), sensor_id("s2")};
  s.bodies = std::move(bodies);
  return s;
}

constexpr auto kMinute = std::chrono::minutes(1);
constexpr auto kSecond = std::chrono::seconds(1);

TEST(Roll, ListsWhoIsThereAndWhoSeesThem) {
  Roll roll(kMinute);
  FusedBody one = body(7, 3);
  one.sides_confidence = 0.98765;
  one.stature = LearnedLength{1.7891, 0.0123};
  EXPECT_TRUE(roll.take(snapshot({}, {one, body(2)})));
  ASSERT_EQ(roll.people().size(), 2u);
  EXPECT_EQ(roll.people()[0].id.value, 2u) << "ordered by id";
  const KnownPerson* seven = roll.find({7});
  ASSERT_NE(seven, nullptr);
  EXPECT_EQ(seven->presence, Presence::Seen);
  EXPECT_EQ(seven->slot, 7u);
  EXPECT_EQ(seven->since, kStart);
  EXPECT_EQ(seven->sensors, (std::vector{sensor_id("s1"), sensor_id("s2")}));
  EXPECT_NEAR(seven->sides_confidence.value_or(0), 0.99, 1e-9);
  EXPECT_NEAR(seven->stature->length, 1.79, 1e-9);
  one.sides_confidence = 0.9867;
  EXPECT_FALSE(roll.take(snapshot(kSecond, {one, body(2)}))) << "nothing that means anything";
  EXPECT_TRUE(roll.take(snapshot(2 * kSecond, {body(7, 1), body(2)}))) << "s2 no longer sees 7";
}

TEST(Roll, SaysWhoWasShownAsSomebodyElse) {
  Roll roll(kMinute);
  roll.take(snapshot({}, {body(3)}));
  Snapshot corrected = snapshot(kSecond, {body(7)});
  corrected.corrections = {{PersonId{3}, {7}, kStart, kStart + kSecond},
                           {{3}, {9}, kStart, kStart}};
  EXPECT_TRUE(roll.take(corrected));
  ASSERT_TRUE(roll.find({7})->correction);
  EXPECT_EQ(roll.find({7})->correction->published, PersonId{3});
  EXPECT_EQ(roll.find({9}), nullptr) << "who is not published";
}

TEST(Roll, WhoLeavesIsRememberedForAWhile) {
  Roll roll(kMinute);
  roll.take(snapshot({}, {body(7)}));
  FusedBody hidden = body(7, 0);
  hidden.carried_for = 0.5;
  EXPECT_TRUE(roll.take(snapshot(kSecond, {hidden})));
  EXPECT_EQ(roll.find({7})->presence, Presence::Expected);
  EXPECT_EQ(roll.find({7})->last_seen, kStart + std::chrono::milliseconds(500));
  EXPECT_TRUE(roll.take(snapshot(2 * kSecond, {})));
  EXPECT_EQ(roll.find({7})->presence, Presence::Left);
  EXPECT_FALSE(roll.find({7})->slot);
  roll.take(snapshot(60 * kSecond, {}));
  EXPECT_NE(roll.find({7}), nullptr);
  EXPECT_TRUE(roll.take(snapshot(61 * kSecond, {})));
  EXPECT_EQ(roll.find({7}), nullptr);
}

TEST(Roll, ANameStaysWithThePerson) {
  Roll roll(kMinute);
  roll.take(snapshot({}, {body(7), body(8)}));
  EXPECT_TRUE(roll.rename({7}, " Anna "));
  EXPECT_EQ(roll.find({7})->name, "Anna");
  EXPECT_EQ(roll.rename({8}, "Anna").error().code, ErrorCode::Conflict);
  EXPECT_EQ(roll.rename({9}, "Bob").error().code, ErrorCode::NotFound);
  EXPECT_EQ(roll.rename({8}, "a/b").error().code, ErrorCode::InvalidArgument);
  roll.take(snapshot(kSecond, {body(8)}));
  roll.take(snapshot(2 * kSecond, {body(7), body(8)}));
  EXPECT_EQ(roll.find({7})->name, "Anna") << "who comes back keeps it";
  roll.take(snapshot(3 * kSecond, {body(8)}));
  EXPECT_TRUE(roll.rename({8}, "Anna")) << "of somebody who left it moves";
  EXPECT_EQ(roll.find({7})->name, "");
  EXPECT_TRUE(roll.rename({8}, ""));
  EXPECT_EQ(roll.find({8})->name, "");
}

TEST(Roll, WhoIsForgottenIsNotListedAgain) {
  Roll roll(kMinute);
  roll.take(snapshot({}, {body(7), body(8)}));
  EXPECT_TRUE(roll.forget({7}));
  EXPECT_EQ(roll.forget({7}).error().code, ErrorCode::NotFound);
  EXPECT_FALSE(roll.take(snapshot(kSecond, {body(7), body(8)}))) << "an instant on its way";
  EXPECT_EQ(roll.find({7}), nullptr);
  EXPECT_TRUE(roll.take(snapshot(2 * kSecond, {body(8), body(9)})));
}

TEST(Roll, ATimeThatGoesBackDoesNotStopIt) {
  Roll roll(kMinute);
  roll.take(snapshot(kMinute * 60, {body(7)}));
  EXPECT_FALSE(roll.take(snapshot(kMinute * 60 - kSecond, {}))) << "an old snapshot";
  EXPECT_NE(roll.find({7}), nullptr);
  EXPECT_TRUE(roll.take(snapshot({}, {body(8)}))) << "a clock that was set back";
  EXPECT_EQ(roll.people().size(), 1u);
  EXPECT_EQ(roll.people()[0].id.value, 8u);
}

}  // namespace
}  // namespace chorus::journal

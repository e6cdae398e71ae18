#include "services/sensor/device/replay/replay_schedule.h"

#include <cmath>

#include <gtest/gtest.h>

namespace chorus::sensor_service {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Timestamp kRecorded = from_unix_ns(1'600'000'000'000'000'000);
const Timestamp kEpoch = from_unix_ns(1'795'246'200'000'000'000);

/// Frames 100, 133, 200 ms after the set's first capture; the set lasts one second.
ReplaySchedule make(double speed = 1.0, bool loop = true) {
  const std::vector<Timestamp> captured{
      kRecorded + milliseconds(100), kRecorded + milliseconds(133), kRecorded + milliseconds(200)};
  auto schedule = ReplaySchedule::make(captured, {kEpoch, kRecorded, seconds(1), speed, loop});
  EXPECT_TRUE(schedule) << to_string(schedule.error());
  return *schedule;
}

TEST(ReplaySchedule, KeepsTheOffsetToTheSetsOrigin) {
  EXPECT_EQ(make().due({0, 0}), kEpoch + milliseconds(100));
  EXPECT_EQ(make().due({2, 0}), kEpoch + milliseconds(200));
}

TEST(ReplaySchedule, LoopsByTheSetsPeriodNotItsOwnLength) {
  EXPECT_EQ(make().due({0, 3}), kEpoch + seconds(3) + milliseconds(100));
}

TEST(ReplaySchedule, SpeedShortensEverything) {
  EXPECT_EQ(make(2.0).due({0, 1}), kEpoch + milliseconds(550));
}

TEST(ReplaySchedule, TimeOnlyGoesForward) {
  for (const double speed : {0.3, 1.0, 7.0}) {
    const auto schedule = make(speed);
    Turn turn;
    for (int i = 0; i < 20; ++i) {
      const Turn next = schedule.after(turn);
      EXPECT_LT(schedule.due(turn), schedule.due(next));
      EXPECT_EQ(schedule.sequence(next), schedule.sequence(turn) + 1);
      turn = next;
    }
  }
}

TEST(ReplaySchedule, ALateStarterJoinsInStep) {
  for (const double speed : {0.5, 1.0, 3.0}) {
    const auto schedule = make(speed);
    for (int ms = -50; ms < 5000; ms += 7) {
      const Timestamp now = kEpoch + milliseconds(ms);
      Turn expected;
      while (schedule.due(expected) < now) expected = schedule.after(expected);
      EXPECT_EQ(schedule.first_from(now), expected) << ms << " ms at speed " << speed;
    }
  }
}

TEST(ReplaySchedule, WithoutLoopItEnds) {
  const auto schedule = make(1.0, false);
  EXPECT_FALSE(schedule.over({2, 0}));
  EXPECT_TRUE(schedule.over(schedule.after({2, 0})));
  EXPECT_TRUE(schedule.over(schedule.first_from(kEpoch + seconds(100))));
}

TEST(ReplaySchedule, RefusesWhatCannotBePlayed) {
  const std::vector<Timestamp> one{kRecorded};
  const std::vector<Timestamp> two{kRecorded, kRecorded + seconds(2)};
  EXPECT_FALSE(ReplaySchedule::make({}, {kEpoch, kRecorded, seconds(1)}));
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, kRecorded + seconds(1), seconds(1)}));
  EXPECT_FALSE(ReplaySchedule::make(two, {kEpoch, kRecorded, seconds(1)}))
      << "the period is too short";
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, kRecorded, Duration::max()}));
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, Timestamp::min(), seconds(1)}));
  const Timestamp rounded = kRecorded + std::chrono::nanoseconds(500);
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, rounded, Duration::zero()}));
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, kRecorded, seconds(1), 0.0}));
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, kRecorded, seconds(1), std::nan("")}));
}

TEST(NaturalPeriod, IsTheLengthAndOneMedianStep) {
  EXPECT_EQ(natural_period({}), seconds(1));
  EXPECT_EQ(natural_period({kRecorded}), seconds(1));
  EXPECT_EQ(natural_period({kRecorded, kRecorded + milliseconds(33), kRecorded + milliseconds(66),
                            kRecorded + milliseconds(166)}),
            milliseconds(199));
}

}  // namespace
}  // namespace chorus::sensor_service

#include "services/sensor/device/replay/replay_schedule.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace chorus::sensor_service {
namespace {

using std::chrono::milliseconds;

const Timestamp kScheduleStart = from_unix_ns(1'600'000'000'000'000'000);
const Timestamp kEpoch = from_unix_ns(1'795'246'200'000'000'000);

/// Frames 100, 133, 200 ms after the set's first capture; the set lasts one second.
constexpr std::array kOffsets{milliseconds(100), milliseconds(133), milliseconds(200)};

TapeSpan span_of(Duration first, Duration last, std::uint64_t frames) {
  return {kScheduleStart + first, kScheduleStart + last, frames, milliseconds(33)};
}

ReplaySchedule make(double speed = 1.0, bool loop = true) {
  auto schedule =
      ReplaySchedule::make(span_of(kOffsets.front(), kOffsets.back(), kOffsets.size()),
                           {kEpoch, kScheduleStart, std::chrono::seconds(1), speed, loop});
  EXPECT_TRUE(schedule) << to_string(schedule.error());
  return *schedule;
}

Turn turn_of(std::size_t number, std::int64_t round) {
  return {kScheduleStart + kOffsets.at(number), number, round};
}

Turn after(const Turn& turn) {
  const bool last = turn.number + 1 == kOffsets.size();
  return last ? turn_of(0, turn.round + 1) : turn_of(turn.number + 1, turn.round);
}

TEST(ReplaySchedule, KeepsTheOffsetToTheSetsOrigin) {
  EXPECT_EQ(make().due(turn_of(0, 0)), kEpoch + milliseconds(100));
  EXPECT_EQ(make().due(turn_of(2, 0)), kEpoch + milliseconds(200));
}

TEST(ReplaySchedule, LoopsByTheSetsPeriodNotItsOwnLength) {
  EXPECT_EQ(make().due(turn_of(0, 3)), kEpoch + std::chrono::seconds(3) + milliseconds(100));
}

TEST(ReplaySchedule, SpeedShortensEverything) {
  EXPECT_EQ(make(2.0).due(turn_of(0, 1)), kEpoch + milliseconds(550));
}

TEST(ReplaySchedule, TimeOnlyGoesForward) {
  for (const double speed : {0.3, 1.0, 7.0}) {
    const auto schedule = make(speed);
    Turn turn = turn_of(0, 0);
    for (int i = 0; i < 20; ++i) {
      const Turn next = after(turn);
      EXPECT_LT(schedule.due(turn), schedule.due(next));
      EXPECT_EQ(schedule.sequence(next), schedule.sequence(turn) + 1);
      turn = next;
    }
  }
}

TEST(ReplaySchedule, ALateStarterNeedsNotLookThroughMoreThanTwoRounds) {
  for (const double speed : {0.5, 1.0, 3.0}) {
    const auto schedule = make(speed);
    for (int ms = -50; ms < 5000; ms += 7) {
      const Timestamp now = kEpoch + milliseconds(ms);
      Turn first = turn_of(0, 0);
      while (schedule.due(first) < now) first = after(first);
      const auto round = schedule.round_before(now);
      EXPECT_LE(round, first.round) << ms << " ms at speed " << speed;
      EXPECT_GE(round + 2, first.round) << ms << " ms at speed " << speed;
    }
  }
}

TEST(ReplaySchedule, WithoutLoopItEnds) {
  const auto schedule = make(1.0, false);
  EXPECT_FALSE(schedule.over(0));
  EXPECT_TRUE(schedule.over(1));
  EXPECT_EQ(schedule.round_before(kEpoch + std::chrono::seconds(100)), 0);
  EXPECT_FALSE(make().over(1));
}

TEST(ReplaySchedule, RefusesWhatCannotBePlayed) {
  const TapeSpan one = span_of(std::chrono::seconds(0), std::chrono::seconds(0), 1);
  const TapeSpan two = span_of(std::chrono::seconds(0), std::chrono::seconds(2), 2);
  EXPECT_FALSE(ReplaySchedule::make({}, {kEpoch, kScheduleStart, std::chrono::seconds(1)}));
  EXPECT_FALSE(ReplaySchedule::make(
      one, {kEpoch, kScheduleStart + std::chrono::seconds(1), std::chrono::seconds(1)}));
  EXPECT_FALSE(ReplaySchedule::make(two, {kEpoch, kScheduleStart, std::chrono::seconds(1)}))
      << "the period is too short";
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, kScheduleStart, Duration::max()}));
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, Timestamp::min(), std::chrono::seconds(1)}));
  const Timestamp rounded = kScheduleStart + std::chrono::nanoseconds(500);
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, rounded, Duration::zero()}));
  EXPECT_FALSE(ReplaySchedule::make(one, {kEpoch, kScheduleStart, std::chrono::seconds(1), 0.0}));
  EXPECT_FALSE(
      ReplaySchedule::make(one, {kEpoch, kScheduleStart, std::chrono::seconds(1), std::nan("")}));
}

TEST(NaturalPeriod, IsTheLengthAndOneStep) {
  EXPECT_EQ(natural_period(span_of(std::chrono::seconds(1), std::chrono::seconds(3), 60)),
            milliseconds(2033));
}

}  // namespace
}  // namespace chorus::sensor_service

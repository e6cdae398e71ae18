// Output instants: on the grid, each once, in order.
#include "fusion-server/core/tick_schedule.h"

#include <gtest/gtest.h>

namespace chorus::core {
namespace {

using std::chrono::milliseconds;

const Timestamp kFirstTick = from_unix_ns(1'790'000'000'000'000'000);

TEST(Grid, IndexAndInstantUndoEachOther) {
  for (const int rate : {1, 7, 30, 60, 90, 240}) {
    const std::int64_t start = grid_index(kFirstTick, rate);
    for (std::int64_t k = start; k < start + 3 * rate; ++k) {
      EXPECT_EQ(grid_index(grid_instant(k, rate), rate), k) << rate;
      EXPECT_EQ(grid_index(grid_instant(k + 1, rate) - Duration{1}, rate), k) << rate;
      EXPECT_LT(grid_instant(k, rate), grid_instant(k + 1, rate));
    }
  }
}

TEST(Grid, WholeSecondsAreOnEveryGrid) {
  for (const int rate : {1, 7, 30, 60}) {
    EXPECT_EQ(grid_instant(grid_index(kFirstTick, rate), rate), kFirstTick) << rate;
  }
}

TEST(TickSchedule, AnswersWhenReadyAndAtTheDeadlineWhenNot) {
  TickSchedule schedule({.alignment_delay = milliseconds(80)});
  const Tick tick = schedule.next(kFirstTick);
  EXPECT_EQ(tick.sequence, 1u);
  EXPECT_GT(tick.instant, kFirstTick);
  EXPECT_EQ(schedule.wait(kFirstTick, true),
            tick.instant - kFirstTick);  // never before the instant itself
  EXPECT_EQ(schedule.wait(tick.instant + milliseconds(5), true), Duration{0});
  EXPECT_EQ(schedule.wait(tick.instant + milliseconds(5), false), milliseconds(75));
  EXPECT_EQ(schedule.wait(tick.instant + milliseconds(80), false), Duration{0});
}

TEST(TickSchedule, WaitsLongerForSlowSensorsWithoutSkipping) {
  TickSchedule schedule({.alignment_delay = milliseconds(80), .max_lag = milliseconds(100)});
  schedule.extend(milliseconds(500));
  const Tick tick = schedule.next(kFirstTick);
  const Timestamp later = tick.instant + milliseconds(570);
  EXPECT_EQ(schedule.next(later).instant, tick.instant);
  EXPECT_EQ(schedule.wait(later, false), milliseconds(10));
  schedule.extend(milliseconds(480));
  EXPECT_EQ(schedule.wait(later, false), Duration{0});
}

TEST(TickSchedule, NoInstantIsLostOrDoubledOverAMinuteOfUnevenWork) {
  TickSchedule schedule({});
  Timestamp now = kFirstTick;
  Timestamp last{};
  std::uint64_t sequence = 0;
  int answers = 0;
  for (int i = 0; now < kFirstTick + std::chrono::seconds(60); ++i) {
    const Tick tick = schedule.next(now);
    // Frames arrive unevenly: at every seventh step, the instant is not ready yet.
    const Duration wait = schedule.wait(now, i % 7 != 0);
    if (wait > Duration{0}) {
      now += std::min<Duration>(wait, milliseconds(1 + i % 11));
      continue;
    }
    if (last != Timestamp{}) {
      EXPECT_EQ(grid_index(tick.instant, 30), grid_index(last, 30) + 1);
    }
    EXPECT_EQ(tick.sequence, ++sequence);
    last = tick.instant;
    now += milliseconds(i % 40 == 0 ? 150 : 1);  // a slow step now and then
    schedule.answered(now);
    ++answers;
  }
  EXPECT_NEAR(answers, 60 * 30, 6);
  EXPECT_EQ(schedule.skipped(), 0u);
}

TEST(TickSchedule, LateAnswersAreSpacedSoThatReadersSeeEachOfThem) {
  TickSchedule schedule({});
  const Tick first = schedule.next(kFirstTick);
  const Timestamp late = first.instant + milliseconds(200);
  schedule.answered(late);
  (void)schedule.next(late);
  EXPECT_EQ(schedule.wait(late, true), TickConfig{}.min_spacing);
  EXPECT_EQ(schedule.wait(late + TickConfig{}.min_spacing, true), Duration{0});
}

TEST(TickSchedule, TheSpacingNeverSlowsAFastOutputDown) {
  TickConfig fast;
  fast.rate_hz = 240;
  TickSchedule schedule(fast);
  Timestamp now = schedule.next(kFirstTick).instant;
  for (int i = 0; i < 240; ++i) {
    while (schedule.wait(now, true) > Duration{0}) now += schedule.wait(now, true);
    schedule.answered(now);
    (void)schedule.next(now);
  }
  EXPECT_LE(now - kFirstTick, std::chrono::milliseconds(1010));
  EXPECT_EQ(schedule.skipped(), 0u);
}

TEST(TickSchedule, ASuspendedHostSkipsAndCountsWhatItSkipped) {
  TickSchedule schedule({});
  const Tick before = schedule.next(kFirstTick);
  schedule.answered(before.instant);
  const Timestamp later = kFirstTick + std::chrono::seconds(100);
  const Tick after = schedule.next(later);
  EXPECT_LE(later - after.instant, milliseconds(34));
  EXPECT_NEAR(static_cast<double>(after.sequence), 3000.0, 2.0);
  EXPECT_EQ(schedule.skipped(), after.sequence - 2);
}

TEST(TickSchedule, AClockSetBackStartsAnewAndTheSequenceStillRises) {
  TickSchedule schedule({});
  const Tick before = schedule.next(kFirstTick);
  schedule.answered(before.instant);
  const Timestamp earlier = kFirstTick - std::chrono::hours(1);
  const Tick after = schedule.next(earlier);
  EXPECT_GT(after.sequence, before.sequence);
  EXPECT_LE(after.instant - earlier, milliseconds(34));
  EXPECT_EQ(schedule.wait(after.instant, true), Duration{0});
}

}  // namespace
}  // namespace chorus::core

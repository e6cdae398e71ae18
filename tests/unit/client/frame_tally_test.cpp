// Counts and rates of a sensor's frames, honest or not; and what reading them costs.
#include "common/client/frame_tally.h"

#include <gtest/gtest.h>

#include "common/client/parse_budget.h"
#include "tests/support/builders.h"

namespace chorus::client {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::kStart;

Dated tallied_frame(std::uint64_t sequence, Duration received) {
  return {sequence, kStart + received - milliseconds(5), kStart + received};
}

TEST(FrameTally, CountsGapsAndWhatFillsThem) {
  FrameTally tally;
  tally.note(tallied_frame(7, milliseconds(0)));
  tally.note(tallied_frame(10, milliseconds(100)));
  EXPECT_EQ(tally.missed(), 2u);
  tally.note_late(tallied_frame(8, milliseconds(150)));
  EXPECT_EQ(tally.missed(), 1u);
  EXPECT_EQ(tally.frames(), 3u);
  EXPECT_EQ(tally.newest(), kStart + milliseconds(95));
}

TEST(FrameTally, ARestartAndAnAbsurdSequenceAreNoGap) {
  FrameTally tally;
  tally.note(tallied_frame(1'795'000'000'000, milliseconds(0)));
  tally.note(tallied_frame(3, milliseconds(33)));
  tally.note(tallied_frame(~std::uint64_t{0}, milliseconds(66)));
  tally.note(tallied_frame(0, milliseconds(99)));
  EXPECT_EQ(tally.missed(), 0u);
}

TEST(FrameTally, TheRateIsOfArrivalsWhateverTheStampsSay) {
  FrameTally tally;
  for (int i = 0; i < 90; ++i) {
    Dated f = tallied_frame(static_cast<std::uint64_t>(i), milliseconds(i * 33));
    f.captured = kStart + microseconds(i);  // a thousand per millisecond
    tally.note(f);
  }
  EXPECT_NEAR(tally.rate_hz(kStart + milliseconds(89 * 33)), 30.3, 1.0);
  EXPECT_EQ(tally.rate_hz(kStart + std::chrono::seconds(5)), 0.0);
}

TEST(FrameTally, AFewAtOnceAreNoThousandASecond) {
  FrameTally tally;
  for (int i = 0; i < 4; ++i)
    tally.note(tallied_frame(static_cast<std::uint64_t>(i), milliseconds(i)));
  EXPECT_LE(tally.rate_hz(kStart + milliseconds(4)), 8.0);
}

/// A sensor at 30 Hz that delivers one frame after the other.
struct Aging {
  AgeWatch watch = {};
  std::uint64_t sequence = 0;

  bool odd(Duration age) {
    const auto received = kStart + milliseconds(33) * static_cast<int>(sequence);
    return watch.odd({++sequence, received - age, received});
  }
};

TEST(AgeWatch, ASteadyAgeIsNeverOddAndAJumpIs) {
  Aging sensor;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(sensor.odd(milliseconds(20 + i % 10))) << i;
  EXPECT_TRUE(sensor.odd(milliseconds(-700)));
  EXPECT_TRUE(sensor.odd(milliseconds(720)));
  EXPECT_FALSE(sensor.odd(milliseconds(22)));
}

TEST(AgeWatch, ALateFrameIsNotOddUnlessItWasCapturedBeforeTheOneItFollows) {
  Aging busy;
  for (int i = 0; i < 50; ++i) (void)busy.odd(milliseconds(5 + 30 * (i % 5)));
  EXPECT_FALSE(busy.odd(milliseconds(30)));
  EXPECT_TRUE(busy.odd(milliseconds(30 + 200))) << "a clock that was set back by 0.2 s";
}

TEST(AgeWatch, WhatStaysBecomesTheRule) {
  Aging sensor;
  for (int i = 0; i < 50; ++i) (void)sensor.odd(milliseconds(20));
  int odd = 0;
  for (int i = 0; i < 50; ++i) odd += sensor.odd(milliseconds(900)) ? 1 : 0;
  EXPECT_LE(odd, 5);
}

TEST(ParseBudget, AnOrdinarySensorNeverRests) {
  ParseBudget budget;
  for (int i = 0; i < 300; ++i)
    EXPECT_EQ(budget.spend(milliseconds(2), milliseconds(33 * i)), Duration{0}) << i;
}

TEST(ParseBudget, WhoCostsMuchRestsTenTimesAsLong) {
  ParseBudget budget;
  Duration now{0};
  Duration spent{0};
  for (int i = 0; i < 50; ++i) {
    now += milliseconds(80) + budget.spend(milliseconds(80), now);
    spent += milliseconds(80);
  }
  EXPECT_LE(spent / now, 1);
  EXPECT_GE(now, 9 * spent);
  EXPECT_LE(now, 12 * spent);
}

}  // namespace
}  // namespace chorus::client

// When the next frame of a stream is overdue.
#include "common/client/stream_rhythm.h"

#include <gtest/gtest.h>

namespace chorus::client {
namespace {

using std::chrono::milliseconds;

/// Delivers frames at equal intervals, the first one at `from`; returns the time of the last one.
Duration run(StreamRhythm& rhythm, milliseconds apart, int frames, Duration from = {}) {
  for (int i = 0; i < frames; ++i) rhythm.saw(from + i * apart);
  return from + (frames - 1) * apart;
}

TEST(StreamRhythm, NobodyLooksAtAStreamThatWasNeverLate) {
  StreamRhythm rhythm;
  EXPECT_FALSE(rhythm.overdue_from(std::chrono::seconds(1)));
  const Duration last = run(rhythm, milliseconds(33), 100);
  EXPECT_FALSE(rhythm.overdue_from(last + milliseconds(50)));
}

TEST(StreamRhythm, AfterAGapTheNextOneIsNoticed) {
  StreamRhythm rhythm;
  const Duration gap = run(rhythm, milliseconds(33), 100) + milliseconds(250);
  rhythm.saw(gap);
  const auto overdue = rhythm.overdue_from(gap);
  ASSERT_TRUE(overdue);
  EXPECT_GT(*overdue - gap, milliseconds(60));
  EXPECT_LT(*overdue - gap, milliseconds(80));
  EXPECT_TRUE(rhythm.overdue_from(gap + std::chrono::seconds(59)));
  EXPECT_FALSE(rhythm.overdue_from(gap + std::chrono::seconds(61))) << "it has been good since";
}

TEST(StreamRhythm, WhatWasHeldUpTogetherDoesNotMakeItFaster) {
  StreamRhythm rhythm;
  Duration last = run(rhythm, milliseconds(33), 50) + milliseconds(250);
  for (int i = 0; i < 20; ++i) last = run(rhythm, milliseconds(1), 7, last) + milliseconds(250);
  rhythm.saw(last);
  EXPECT_GT(*rhythm.overdue_from(last) - last, milliseconds(60));
}

TEST(StreamRhythm, ASlowSensorIsNotLate) {
  StreamRhythm rhythm;
  const Duration last = run(rhythm, milliseconds(200), 50);
  EXPECT_FALSE(rhythm.overdue_from(last + milliseconds(300)));
  rhythm.saw(last + milliseconds(900));
  EXPECT_EQ(*rhythm.overdue_from(last + milliseconds(900)), last + milliseconds(1300));
}

TEST(StreamRhythm, ASensorThatSlowsDownIsSlowSoon) {
  StreamRhythm rhythm;
  Duration last = run(rhythm, milliseconds(33), 50);
  last = run(rhythm, milliseconds(50), 200, last + milliseconds(50));
  EXPECT_FALSE(rhythm.overdue_from(last + milliseconds(1)));
  last = run(rhythm, milliseconds(90), 200, last + milliseconds(90));
  EXPECT_FALSE(rhythm.overdue_from(last + milliseconds(1))) << "less than twice as long";
}

TEST(StreamRhythm, ANewStreamIsOfAnotherSensorPerhaps) {
  StreamRhythm rhythm;
  rhythm.saw(run(rhythm, milliseconds(33), 50) + milliseconds(250));
  rhythm.restart();
  EXPECT_FALSE(rhythm.overdue_from(milliseconds(2000)));
  const Duration last = run(rhythm, milliseconds(200), 5, std::chrono::seconds(3));
  EXPECT_EQ(*rhythm.overdue_from(last), last + milliseconds(400));
}

}  // namespace
}  // namespace chorus::client

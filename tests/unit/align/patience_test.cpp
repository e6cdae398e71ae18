// One bad link does not make everybody wait.
#include "fusion-server/align/patience.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::align {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

/// Thirty frames a second whose delay to us goes from `least` to `most` and back.
History sensor(Duration least, Duration most, int frames = 60) {
  History history;
  for (int i = 0; i < frames; ++i) {
    SensorFrame frame;
    frame.sequence = static_cast<std::uint64_t>(i);
    frame.captured = kStart + milliseconds(33 * i);
    frame.received = frame.captured + least + (most - least) * (i % 8) / 7;
    history.push(frame);
  }
  return history;
}

TEST(Patience, OneUnsteadySensorIsWaitedForNoLongerThanTheOthersNeed) {
  const History good = sensor(milliseconds(2), milliseconds(5));
  const History bad = sensor(milliseconds(0), milliseconds(150));
  const Patience patience({{sensor_id("s1"), &good},
                           {sensor_id("s2"), &good},
                           {sensor_id("s3"), &good},
                           {sensor_id("s4"), &bad}},
                          {});
  EXPECT_EQ(patience.of(bad).patience, *usual_wait(good));
  EXPECT_LT(patience.of(bad).patience, milliseconds(60));
  EXPECT_EQ(patience.of(good).patience, AlignConfig{}.patience);
}

TEST(Patience, ASteadyOneIsGivenWhatItNeeds) {
  const History quick = sensor(milliseconds(2), milliseconds(5));
  const History slow = sensor(milliseconds(100), milliseconds(110));
  const Patience patience({{sensor_id("s1"), &quick}, {sensor_id("s2"), &slow}}, {});
  EXPECT_EQ(patience.of(slow).patience, AlignConfig{}.patience);
}

TEST(Patience, WhereAllAreUnsteadyTheMiddleOneRules) {
  const History bad = sensor(milliseconds(0), milliseconds(100));
  const Patience patience({{sensor_id("s1"), &bad}, {sensor_id("s2"), &bad}}, {});
  EXPECT_EQ(patience.of(bad).patience, *usual_wait(bad));
}

TEST(Patience, OfNewSensorsNothingIsKnown) {
  const History young = sensor(milliseconds(0), milliseconds(100), 5);
  const Patience patience({{sensor_id("s1"), &young}}, {});
  EXPECT_EQ(patience.of(young).patience, AlignConfig{}.patience);
}

TEST(Habit, FramesThatFilledAGapTellNothingOfIt) {
  History history = sensor(milliseconds(2), milliseconds(5), 20);
  SensorFrame ahead;
  ahead.sequence = 22;
  ahead.captured = kStart + milliseconds(33 * 22);
  ahead.received = ahead.captured + milliseconds(4);
  history.push(ahead);
  for (std::uint64_t sequence : {20u, 21u}) {
    SensorFrame late;
    late.sequence = sequence;
    late.captured = kStart + milliseconds(33 * sequence);
    late.received = ahead.received + milliseconds(100);
    EXPECT_EQ(history.push(late), PushVerdict::Late);
  }
  ASSERT_EQ(history.frames().size(), 23u);
  EXPECT_LE(history.habit()->most_delay, milliseconds(5));
  EXPECT_EQ(history.habit()->gap, milliseconds(33));
}

}  // namespace
}  // namespace chorus::align

// How long an instant waits for each sensor: one bad link does not delay everybody.
#include "fusion-server/align/patience.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::align {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

/// Thirty frames per second whose delay repeatedly goes from `least` to `most`; none overtakes
/// another.
History sensor(Duration least, Duration most, int frames = 60) {
  History history;
  Timestamp before{};
  for (int i = 0; i < frames; ++i) {
    SensorFrame frame;
    frame.sequence = static_cast<std::uint64_t>(i);
    frame.captured = kStart + milliseconds(33 * i);
    frame.received = std::max(before, frame.captured + least + (most - least) * (i % 8) / 7);
    before = frame.received;
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

TEST(Patience, TheOrderOfTheSensorsDoesNotMatter) {
  const History good = sensor(milliseconds(2), milliseconds(5));
  const History bad = sensor(milliseconds(0), milliseconds(150));
  for (int place = 1; place <= 4; ++place) {
    std::map<SensorId, const History*> histories;
    for (int i = 1; i <= 4; ++i)
      histories[sensor_id("s" + std::to_string(i))] = i == place ? &bad : &good;
    EXPECT_EQ(Patience(histories, {}).of(bad).patience, *usual_wait(good)) << place;
  }
}

TEST(Patience, ASteadyOneIsGivenWhatItNeeds) {
  const History quick = sensor(milliseconds(2), milliseconds(5));
  const History slow = sensor(milliseconds(100), milliseconds(110));
  const Patience patience({{sensor_id("s1"), &quick}, {sensor_id("s2"), &slow}}, {});
  EXPECT_EQ(patience.of(slow).patience, AlignConfig{}.patience);
}

/// A history of 60 frames that took 3 ms to arrive, except frame 60 - `later`, which took `delay`.
History held_up(Duration delay, int later = 5) {
  History history;
  for (int i = 0; i < 60; ++i) {
    SensorFrame frame;
    frame.sequence = static_cast<std::uint64_t>(i);
    frame.captured = kStart + milliseconds(33 * i);
    frame.received = frame.captured + (i == 60 - later ? delay : milliseconds(3));
    history.push(frame);
  }
  return history;
}

TEST(Patience, OneThatWasHeldUpOnceIsSteadyAndMakesNoRoomForTheUnsteadyOne) {
  const History once = held_up(milliseconds(30), 1);
  const History long_ago = held_up(milliseconds(150));
  const History bad = sensor(milliseconds(0), milliseconds(400));
  const Patience patience(
      {{sensor_id("s1"), &once}, {sensor_id("s2"), &long_ago}, {sensor_id("s3"), &bad}}, {});
  EXPECT_EQ(patience.of(once).patience, AlignConfig{}.patience);
  EXPECT_LT(patience.of(bad).patience, milliseconds(60));
}

TEST(Patience, WhereAllAreAlikeNobodyIsUnsteady) {
  const History bad = sensor(milliseconds(0), milliseconds(100));
  const Patience patience({{sensor_id("s1"), &bad}, {sensor_id("s2"), &bad}}, {});
  EXPECT_EQ(patience.of(bad).patience, AlignConfig{}.patience);
}

TEST(Patience, OnABusyMachineTheWorstOfAllIsUnsteady) {
  const History busy = sensor(milliseconds(5), milliseconds(80));
  const History bad = sensor(milliseconds(0), milliseconds(400));
  const Patience patience({{sensor_id("s1"), &busy},
                           {sensor_id("s2"), &busy},
                           {sensor_id("s3"), &busy},
                           {sensor_id("s4"), &bad}},
                          {});
  EXPECT_EQ(patience.of(busy).patience, AlignConfig{}.patience);
  EXPECT_EQ(patience.of(bad).patience, *usual_wait(busy));
}

/// A camera that delivers five frames per second, of rays or of points, `delay` after their
/// capture.
History camera(Duration delay, bool rays = true) {
  History history;
  for (int i = 0; i < 20; ++i) {
    SensorFrame frame;
    frame.sequence = static_cast<std::uint64_t>(i);
    frame.captured = kStart + milliseconds(200 * i);
    frame.received = frame.captured + delay;
    frame.bodies.resize(1);
    Joint& neck = frame.bodies[0].skeleton[JointId::Neck];
    neck.position = {0, 0, 1};
    neck.state = JointState::Tracked;
    neck.measurement = rays ? Measurement::Ray : Measurement::Point;
    history.push(frame);
  }
  return history;
}

TEST(Patience, GrowsWhereMostAreSlow) {
  const History slow = camera(milliseconds(250));
  const History quick = sensor(milliseconds(2), milliseconds(5));
  const Patience most(
      {{sensor_id("s1"), &quick}, {sensor_id("s2"), &slow}, {sensor_id("s3"), &slow}}, {});
  // The patience is twice the period plus the delay.
  EXPECT_EQ(most.of(slow).patience, milliseconds(900));
  EXPECT_EQ(most.extension(), milliseconds(900) - AlignConfig{}.patience);
  const Patience few(
      {{sensor_id("s1"), &quick}, {sensor_id("s2"), &quick}, {sensor_id("s3"), &slow}}, {});
  EXPECT_EQ(few.of(slow).patience, AlignConfig{}.patience);
  EXPECT_EQ(few.extension(), Duration{0});
}

TEST(Patience, DoesNotGrowBecauseTheComputerIsBusy) {
  const History busy = sensor(milliseconds(5), milliseconds(150));
  const Patience patience({{sensor_id("s1"), &busy}, {sensor_id("s2"), &busy}}, {});
  EXPECT_EQ(patience.extension(), Duration{0});
}

TEST(Patience, OfTwoCamerasBothAreNeeded) {
  const History slow = camera(milliseconds(250));
  const History quick = camera(milliseconds(10));
  const History points = camera(milliseconds(10), false);
  const Patience rays({{sensor_id("s1"), &quick}, {sensor_id("s2"), &slow}}, {});
  EXPECT_GT(rays.of(slow).patience, milliseconds(465));
  const Patience mixed({{sensor_id("s1"), &points}, {sensor_id("s2"), &slow}}, {});
  EXPECT_LT(mixed.of(slow).patience, milliseconds(465));
}

TEST(Patience, GrowsUpToALimit) {
  const History slow = camera(milliseconds(1800));
  const std::map<SensorId, const History*> two{{sensor_id("s1"), &slow}, {sensor_id("s2"), &slow}};
  EXPECT_EQ(Patience(two, {}).of(slow).patience, AlignConfig{}.slowest);
  AlignConfig never;
  never.slowest = Duration{0};
  EXPECT_EQ(Patience(two, never).of(slow).patience, never.patience);
  EXPECT_EQ(Patience(two, never).extension(), Duration{0});
}

TEST(Patience, OfNewSensorsNothingIsKnown) {
  const History young = sensor(milliseconds(0), milliseconds(100), 5);
  const Patience patience({{sensor_id("s1"), &young}}, {});
  EXPECT_EQ(patience.of(young).patience, AlignConfig{}.patience);
}

TEST(Habit, FramesThatCameAfterLaterOnesTellNothing) {
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
  EXPECT_LE(history.habit()->late_delay, milliseconds(5));
  // The longest wait is from just after frame 19 until frame 22 arrived.
  EXPECT_EQ(history.habit()->longest_wait, milliseconds(3 * 33 + 4));
}

}  // namespace
}  // namespace chorus::align

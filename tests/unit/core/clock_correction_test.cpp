// The clock offsets that a walk found are added to capture times, and are followed while clock
// drift.
#include "fusion-server/core/clock_correction.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

constexpr Duration kFrame = milliseconds(33);
constexpr Duration kLatency = milliseconds(10);
constexpr Duration kOff = milliseconds(200);  // the sensor's clock is behind ours by this

/// A frame without bodies, of a clock that is `behind` ours, `t` after the start.
SensorFrame frame_at(Duration t, Duration behind, Duration latency = kLatency) {
  SensorFrame frame = testing::sensor_frame("s2", kStart + t - behind, {});
  frame.received = kStart + t + latency;
  frame.clock_sigma = kUnknownClock;
  return frame;
}

Registration walked() {
  Registration registration = ring();
  ClockOffset clock{kOff, milliseconds(4)};
  clock.least_age = kOff + kLatency;
  registration.clocks[sensor_id("s2")] = clock;
  return registration;
}

Duration added(const ClockCorrection& clock) {
  const auto& own = clock.walked();
  return own ? own->added : Duration{0};
}

/// Takes frames from `from` on for `length`; returns the sum of the moves that take() asked for.
template <class Behind>
Duration run(ClockCorrection& clock, const Registration& registration, Duration from,
             Duration length, const Behind& behind) {
  Duration moved{0};
  for (Duration t = from; t < from + length; t += kFrame)
    moved += clock.take(frame_at(t, behind(t)), registration);
  return moved;
}

constexpr auto kAsWalked = [](Duration) { return kOff; };

TEST(ClockCorrection, TheFirstFrameIsMovedAndTheRestStays) {
  ClockCorrection clock;
  EXPECT_EQ(clock.take(frame_at(Duration{0}, kOff), walked()), kOff);
  EXPECT_EQ(run(clock, walked(), kFrame, std::chrono::seconds(60), kAsWalked), Duration{0});
  EXPECT_EQ(added(clock), kOff);
}

TEST(ClockCorrection, WithoutTheRegistrationEverythingIsAsBefore) {
  ClockCorrection clock;
  (void)run(clock, walked(), Duration{0}, std::chrono::seconds(5), kAsWalked);
  EXPECT_EQ(clock.take(frame_at(std::chrono::seconds(5), kOff), ring()), -kOff);
  EXPECT_FALSE(clock.walked());
}

TEST(ClockCorrection, LatenciesAreTakenOffWhateverTheClock) {
  Registration registration = walked();
  registration.latencies[sensor_id("s2")] = {milliseconds(40), milliseconds(2), true};
  ClockCorrection clock;
  EXPECT_EQ(clock.take(frame_at(Duration{0}, kOff), registration), kOff - milliseconds(40));
  EXPECT_EQ(clock.added(), kOff - milliseconds(40));
  EXPECT_EQ(added(clock), kOff) << "the clock's own part";
  SensorFrame exact = frame_at(kFrame, Duration{0});
  exact.clock_sigma = 1e-4;
  EXPECT_EQ(clock.take(exact, registration), -kOff) << "the clock is known now";
  registration.latencies.at(sensor_id("s2")).applied = false;
  EXPECT_EQ(clock.take(exact, registration), milliseconds(40)) << "only told";
  EXPECT_EQ(clock.added(), Duration{0});
}

TEST(ClockCorrection, AHostThatBeginsToAnswerWithItsTimeIsBelievedInstead) {
  ClockCorrection clock;
  (void)run(clock, walked(), Duration{0}, std::chrono::seconds(5), kAsWalked);
  SensorFrame corrected = frame_at(std::chrono::seconds(5), Duration{0});
  corrected.clock_sigma =
      0.02;  // less precise than what the walk found, but it is for these very stamps
  EXPECT_EQ(clock.take(corrected, walked()), -kOff);
}

TEST(ClockCorrection, WhatAWalkAddedToAnsweredTimesHoldsUntilTheAnswersKnowBetter) {
  Registration registration = walked();
  registration.clocks.at(sensor_id("s2")).stated = milliseconds(20);
  ClockCorrection clock;
  SensorFrame frame = frame_at(Duration{0}, Duration{0});
  frame.clock_sigma = 0.02;
  EXPECT_EQ(clock.take(frame, registration), kOff);
  frame.captured += kFrame;
  frame.clock_sigma = 0.003;
  EXPECT_EQ(clock.take(frame, registration), -kOff);
}

TEST(ClockCorrection, AnEstimateThatHasImprovedHasMovedAwayFromTheWalk) {
  Registration registration = walked();  // sigma 4 ms
  registration.clocks.at(sensor_id("s2")).stated = milliseconds(20);
  ClockCorrection clock;
  SensorFrame frame = frame_at(Duration{0}, Duration{0});
  const auto take = [&](double sigma) {
    frame.captured += kFrame;
    frame.clock_sigma = sigma;
    return clock.take(frame, registration);
  };
  EXPECT_EQ(take(0.020), kOff);
  EXPECT_EQ(take(0.016), Duration{0});
  // 8 ms is still worse than the walk's 4 ms.  But an estimate that has improved from 20 to 8 ms
  // has moved by about sqrt(20^2 - 8^2) ms, which the walk's offset does not contain.
  EXPECT_EQ(take(0.008), -kOff);
  for (const double worse : {0.009, 0.016, 0.020})
    EXPECT_EQ(take(worse), Duration{0}) << "to and fro would move frames to and fro";
  ++registration.version;
  EXPECT_EQ(take(0.020), kOff) << "another walk";
}

TEST(ClockCorrection, AfterASilenceOneLateFrameSetsNoClock) {
  ClockCorrection clock;
  (void)run(clock, walked(), Duration{0}, std::chrono::seconds(10), kAsWalked);
  const Duration later = std::chrono::seconds(55);
  EXPECT_EQ(clock.take(frame_at(later, kOff, milliseconds(900)), walked()), Duration{0});
  EXPECT_EQ(run(clock, walked(), later + kFrame, std::chrono::seconds(10), kAsWalked), Duration{0});
  EXPECT_EQ(added(clock), kOff);
  // A clock that was set during a silence is followed after it.
  (void)run(clock, walked(), std::chrono::seconds(120), std::chrono::seconds(4),
            [](Duration) { return milliseconds(500); });
  EXPECT_EQ(added(clock), milliseconds(500));
}

TEST(ClockCorrection, ADriftingClockIsFollowed) {
  ClockCorrection clock;
  const auto drifting = [](Duration t) { return kOff + t / 10'000; };  // 100 ppm
  (void)run(clock, walked(), Duration{0}, std::chrono::minutes(20), drifting);
  EXPECT_NEAR(chorus::seconds(added(clock)), 0.200 + 0.120, 0.008);
}

TEST(ClockCorrection, ASetClockIsFollowedWithinSeconds) {
  ClockCorrection ahead;
  (void)run(ahead, walked(), Duration{0}, std::chrono::seconds(10), kAsWalked);
  (void)run(ahead, walked(), std::chrono::seconds(10), 4 * kFrame,
            [](Duration) { return milliseconds(-300); });
  EXPECT_EQ(added(ahead), milliseconds(-300));
  ClockCorrection back;
  (void)run(back, walked(), Duration{0}, std::chrono::seconds(10), kAsWalked);
  (void)run(back, walked(), std::chrono::seconds(10), std::chrono::seconds(4),
            [](Duration) { return milliseconds(900); });
  EXPECT_EQ(added(back), milliseconds(900));
}

TEST(ClockCorrection, ALinkThatHasBecomeSlowerIsNoClock) {
  ClockCorrection clock;
  (void)run(clock, walked(), Duration{0}, std::chrono::seconds(10), kAsWalked);
  for (Duration t = std::chrono::seconds(10); t < std::chrono::seconds(40); t += kFrame)
    (void)clock.take(frame_at(t, kOff, milliseconds(260)), walked());
  EXPECT_EQ(added(clock), kOff);
}

TEST(ClockCorrection, OddFramesAndABusyLinkChangeNothing) {
  ClockCorrection clock;
  (void)run(clock, walked(), Duration{0}, std::chrono::seconds(10), kAsWalked);
  (void)clock.take(frame_at(std::chrono::seconds(10), milliseconds(-500)),
                   walked());  // one from the future
  EXPECT_EQ(added(clock), kOff);
  for (Duration t = std::chrono::seconds(10) + kFrame; t < std::chrono::seconds(30); t += kFrame)
    (void)clock.take(frame_at(t, kOff, milliseconds(60)), walked());
  EXPECT_EQ(added(clock), kOff);
}

}  // namespace
}  // namespace chorus::core

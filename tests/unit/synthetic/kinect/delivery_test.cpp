#include "common/synthetic/kinect/delivery.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus::synthetic::kinect {
namespace {

constexpr Timestamp kDeliveryStart = from_unix_ns(1'795'000'000'000'000'000);
const Delivery kDelivery = nominal_profile("A").delivery;

TEST(Delivery, FramesComeAtTheStatedPaceWithBoundedJitter) {
  const std::uint64_t first = first_frame(kDelivery, kDeliveryStart, {});
  EXPECT_GE(exposure(kDelivery, first, {}), kDeliveryStart);
  EXPECT_LT(exposure(kDelivery, first - 1, {}), kDeliveryStart);
  const Timestamp begin = exposure(kDelivery, first, {});
  for (std::uint64_t i = 1; i < 1000; ++i) {
    const double expected = static_cast<double>(i) * kDelivery.period;
    EXPECT_NEAR(seconds(exposure(kDelivery, first + i, {}) - begin), expected,
                2 * kDelivery.jitter + 1e-6);
  }
}

TEST(Delivery, EachSensorHasItsOwnPhase) {
  const std::uint64_t number = first_frame(kDelivery, kDeliveryStart, {1, 0, 0});
  EXPECT_NE(exposure(kDelivery, number, {1, 0, 0}), exposure(kDelivery, number, {1, 1, 0}));
}

TEST(Delivery, DropsTheStatedShare) {
  Delivery steady = kDelivery;
  steady.slow_share = 0;
  int dropped = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) dropped += is_dropped(steady, i, {});
  EXPECT_NEAR(dropped / 20'000.0, steady.drop_share, 0.3 * steady.drop_share);
}

TEST(Delivery, RunsAtHalfTheRateInEpisodesOfTheStatedShareAndLength) {
  Delivery slow = kDelivery;
  slow.drop_share = 0;
  slow.slow_share = 0.2;
  slow.slow_time = 3.0;
  constexpr int kFrames = 400'000;
  int missing = 0;
  int run = 0;  // frames of the current episode
  for (std::uint64_t i = 0; i < kFrames; i += 2) {
    EXPECT_FALSE(is_dropped(slow, i, {})) << "every other frame stays";
    const bool gone = is_dropped(slow, i + 1, {});
    missing += gone;
    if (!gone && run > 0) {
      EXPECT_GE(run * slow.period, slow.slow_time - 3 * slow.period);
    }
    run = gone ? run + 2 : 0;
  }
  EXPECT_NEAR(2.0 * missing / kFrames, slow.slow_share, 0.02);
  EXPECT_GT(kDelivery.slow_share, 0.0) << "profile A has such episodes";
  slow.slow_share = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) EXPECT_FALSE(is_dropped(slow, i, {}));
}

TEST(Delivery, LosesPeopleForTheStatedTimesAtTheStatedRate) {
  int gaps = 0;
  double length = 0;
  bool before = false;
  constexpr double kLength = 12 * 3600.0;
  for (double time = 0; time < kLength; time += 0.05) {
    const bool lost = is_lost(kDelivery, time, {});
    gaps += lost && !before;
    if (before && !lost) {
      EXPECT_GE(length, kDelivery.gap_least - 0.06);
      EXPECT_LE(length, kDelivery.gap_most + 0.06);
    }
    length = lost ? length + 0.05 : 0.0;
    before = lost;
  }
  EXPECT_NEAR(gaps / (kLength / 60), kDelivery.gaps_per_minute, 0.15 * kDelivery.gaps_per_minute);
}

TEST(Delivery, LatencyIsNeverNegativeAndScattersAsStated) {
  double sum = 0, squares = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const double value = seconds(latency(kDelivery, i, {}));
    EXPECT_GE(value, 0.0);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / 5000;
  EXPECT_NEAR(mean, kDelivery.latency, 0.001);
  EXPECT_NEAR(std::sqrt(squares / 5000 - mean * mean), kDelivery.latency_jitter, 0.001);
}

TEST(HostClock, OffsetDriftAndStepAddUp) {
  HostClock clock;
  clock.origin = kDeliveryStart;
  EXPECT_EQ(clock.host_time(kDeliveryStart), kDeliveryStart);
  clock.offset = 0.25;
  clock.drift = 50e-6;
  clock.step = -1.5;
  clock.step_at = kDeliveryStart + std::chrono::seconds(100);
  EXPECT_NEAR(seconds(clock.host_time(kDeliveryStart) - kDeliveryStart), 0.25, 1e-9);
  const Timestamp before = kDeliveryStart + std::chrono::seconds(99);
  const Timestamp after = kDeliveryStart + std::chrono::seconds(200);
  EXPECT_NEAR(seconds(clock.host_time(before) - before), 0.25 + 99 * 50e-6, 1e-8);
  EXPECT_NEAR(seconds(clock.host_time(after) - after), 0.25 + 200 * 50e-6 - 1.5, 1e-8);
}

TEST(HostClock, IsDrawnPerSensorWithTheStatedSpread) {
  ClockError error;
  error.offset = 0.005;
  error.drift = 20e-6;
  double offsets = 0, drifts = 0;
  for (std::uint64_t sensor = 0; sensor < 2000; ++sensor) {
    const HostClock clock = draw_clock(error, kDeliveryStart, {1, sensor, 0});
    offsets += clock.offset * clock.offset;
    drifts += clock.drift * clock.drift;
  }
  EXPECT_NEAR(std::sqrt(offsets / 2000), 0.005, 0.0004);
  EXPECT_NEAR(std::sqrt(drifts / 2000), 20e-6, 1.6e-6);
  EXPECT_EQ(draw_clock(ClockError{}, kDeliveryStart, {}).host_time(kDeliveryStart), kDeliveryStart);
}

TEST(HostClock, StepsOnTheStatedShareOfHostsEitherWayWithinTheStatedTime) {
  ClockError error;
  error.step = 0.128;
  error.step_chance = 0.3;
  error.step_within = 60;
  int stepped = 0, forward = 0;
  for (std::uint64_t sensor = 0; sensor < 2000; ++sensor) {
    const HostClock clock = draw_clock(error, kDeliveryStart, {1, sensor, 0});
    EXPECT_EQ(clock.host_time(kDeliveryStart - std::chrono::seconds(1)),
              kDeliveryStart - std::chrono::seconds(1));
    const Timestamp end = kDeliveryStart + std::chrono::seconds(60);
    const double jump = seconds(clock.host_time(end) - end);
    if (jump == 0) continue;
    ++stepped;
    forward += jump > 0;
    EXPECT_NEAR(std::abs(jump), 0.128, 1e-8);
    EXPECT_GE(clock.step_at, kDeliveryStart);
    EXPECT_LE(clock.step_at, end);
  }
  EXPECT_NEAR(stepped / 2000.0, 0.3, 0.04);
  EXPECT_NEAR(forward / static_cast<double>(stepped), 0.5, 0.08);
}

TEST(HostClock, NeverStepsInTheFrozenProfiles) {
  for (const char* profile : {"A", "B"}) {
    for (std::uint64_t sensor = 0; sensor < 200; ++sensor) {
      const HostClock clock =
          draw_clock(nominal_profile(profile).clock, kDeliveryStart, {1, sensor, 0});
      EXPECT_EQ(clock.step_at, Timestamp::max());
    }
  }
}

}  // namespace
}  // namespace chorus::synthetic::kinect

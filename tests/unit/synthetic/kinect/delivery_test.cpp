#include "common/synthetic/kinect/delivery.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus::synthetic::kinect {
namespace {

constexpr Timestamp kStart = from_unix_ns(1'795'000'000'000'000'000);
const Delivery kDelivery = nominal_profile("A").delivery;

TEST(Delivery, FramesComeAtTheStatedPaceWithBoundedJitter) {
  const std::uint64_t first = first_frame(kDelivery, kStart, {});
  EXPECT_GE(exposure(kDelivery, first, {}), kStart);
  EXPECT_LT(exposure(kDelivery, first - 1, {}), kStart);
  const Timestamp begin = exposure(kDelivery, first, {});
  for (std::uint64_t i = 1; i < 1000; ++i) {
    const double expected = static_cast<double>(i) * kDelivery.period;
    EXPECT_NEAR(seconds(exposure(kDelivery, first + i, {}) - begin), expected,
                2 * kDelivery.jitter + 1e-6);
  }
}

TEST(Delivery, EachSensorHasItsOwnPhase) {
  const std::uint64_t number = first_frame(kDelivery, kStart, {1, 0, 0});
  EXPECT_NE(exposure(kDelivery, number, {1, 0, 0}), exposure(kDelivery, number, {1, 1, 0}));
}

TEST(Delivery, DropsTheStatedShare) {
  int dropped = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) dropped += is_dropped(kDelivery, i, {});
  EXPECT_NEAR(dropped / 20'000.0, kDelivery.drop_share, 0.3 * kDelivery.drop_share);
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
  clock.origin = kStart;
  EXPECT_EQ(clock.host_time(kStart), kStart);
  clock.offset = 0.25;
  clock.drift = 50e-6;
  clock.step = -1.5;
  clock.step_at = kStart + std::chrono::seconds(100);
  EXPECT_NEAR(seconds(clock.host_time(kStart) - kStart), 0.25, 1e-9);
  const Timestamp before = kStart + std::chrono::seconds(99);
  const Timestamp after = kStart + std::chrono::seconds(200);
  EXPECT_NEAR(seconds(clock.host_time(before) - before), 0.25 + 99 * 50e-6, 1e-8);
  EXPECT_NEAR(seconds(clock.host_time(after) - after), 0.25 + 200 * 50e-6 - 1.5, 1e-8);
}

TEST(HostClock, IsDrawnPerSensorWithTheStatedSpread) {
  const ClockError error{0.005, 20e-6, 0.0};
  double offsets = 0, drifts = 0;
  for (std::uint64_t sensor = 0; sensor < 2000; ++sensor) {
    const HostClock clock = draw_clock(error, kStart, {1, sensor, 0});
    offsets += clock.offset * clock.offset;
    drifts += clock.drift * clock.drift;
  }
  EXPECT_NEAR(std::sqrt(offsets / 2000), 0.005, 0.0004);
  EXPECT_NEAR(std::sqrt(drifts / 2000), 20e-6, 1.6e-6);
  EXPECT_EQ(draw_clock(ClockError{}, kStart, {}).host_time(kStart), kStart);
}

}  // namespace
}  // namespace chorus::synthetic::kinect

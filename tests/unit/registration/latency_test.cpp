// Sensors whose clocks are known, and that differ in latency: the walk tells by how much.
#include "fusion-server/registration/latency.h"

#include <cmath>

#include <gtest/gtest.h>

#include "fusion-server/registration/offset_profile.h"
#include "fusion-server/registration/pair_latency.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

using std::chrono::milliseconds;

/// Sensors on a ring, 70 deg apart, that stamp what they see this much later.
std::vector<WalkTrack> late_ring(const std::vector<int>& late_ms, WalkSpec spec = {}) {
  std::vector<WalkTrack> walk;
  for (std::size_t i = 0; i < late_ms.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    walk.push_back(watch(number, ring_place(deg(70.0 * number)), spec));
    for (SensorFrame& frame : walk.back().frames) move_in_time(frame, milliseconds(late_ms[i]));
  }
  return walk;
}

Latencies latencies_in(const std::vector<WalkTrack>& walk) {
  return solve(walk, kWalkStart, {}).latencies;
}

double ms_of(Duration duration) { return 1e3 * seconds(duration); }

Eigen::Vector2d round_walk(double t) {
  return {1.2 * std::sin(0.75 * t), 1.2 * std::cos(0.75 * t)};
}

TEST(Latencies, AreToldAndTakenOff) {
  const auto walk = late_ring({0, 20, 0, 50, 0});
  const Latencies told = latencies_in(walk);
  ASSERT_EQ(told.size(), 5u);
  for (const auto& [number, late] : {std::pair{1, 0}, {2, 20}, {3, 0}, {4, 50}, {5, 0}}) {
    const Latency& latency = told.at(sensor(number));
    EXPECT_LT(ms_of(latency.sigma), 4.0) << number;
    EXPECT_NEAR(ms_of(latency.found), late, 3.0 * ms_of(latency.sigma) + 0.5) << number;
    EXPECT_EQ(latency.applied, late > 0) << number;
    EXPECT_EQ(latency.added(), late > 0 ? -latency.found : Duration{0});
  }
}

TEST(Latencies, AreNotClaimedWhereThereAreNone) {
  for (const auto& [sensor, latency] : latencies_in(late_ring({0, 0, 0, 0}))) {
    EXPECT_FALSE(latency.applied) << sensor.str() << " " << ms_of(latency.found);
  }
}

TEST(Latencies, AreWithinTheirStatedSigma) {
  int inside = 0;
  int asked = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    WalkSpec spec;
    spec.seed = seed;
    spec.length = 10;
    const Latencies told = latencies_in(late_ring({0, 0, 30}, spec));
    for (int number = 1; number <= 3; ++number) {
      const Latency& latency = told.at(sensor(number));
      if (latency.sigma == Duration{0}) continue;  // what the others are compared with
      const double off = ms_of(latency.found) - (number == 3 ? 30 : 0);
      inside += std::abs(off) < 1.96 * ms_of(latency.sigma) ? 1 : 0;
      ++asked;
    }
  }
  EXPECT_EQ(asked, 8);
  EXPECT_GE(inside, 7);
}

TEST(Latencies, OfACircleAreLeftAtZero) {
  WalkSpec spec;
  spec.path = round_walk;
  spec.noise = 0.02;
  auto walk = late_ring({0, 50}, spec);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Eigen::Isometry3d sensor_from_world =
        ring_place(deg(70.0 * static_cast<double>(i + 1))).inverse();
    for (SensorFrame& frame : walk[i].frames) {
      const double t = seconds(frame.captured - kWalkStart - milliseconds(i == 0 ? 0 : 50));
      const Eigen::Vector3d bob(0, 0.02 * std::sin(8.0 * t), 0);
      Skeleton<SensorSpace>& body = frame.bodies[0].skeleton;
      for (std::size_t j = 0; j < kJointCount; ++j) {
        body.joints[j].position -= sensor_from_world.linear() * bob;
        const auto id = static_cast<JointId>(j);
        const bool on_axis = id == JointId::Neck || id == JointId::SpineShoulder ||
                             id == JointId::Head || id == JointId::SpineMid;
        if (!on_axis) body.joints[j].state = JointState::NotTracked;
      }
    }
  }
  const Latencies told = latencies_in(walk);
  for (const auto& [sensor, latency] : told) EXPECT_FALSE(latency.applied) << sensor.str();
}

TEST(Latencies, BelongToClocksThatAreKnown) {
  auto walk = late_ring({0, 30, 0});
  for (SensorFrame& frame : walk[1].frames) frame.clock_sigma = 0.1;
  const Registration found = solve(walk, kWalkStart, {});
  EXPECT_FALSE(found.latencies.contains(sensor(2)));
  EXPECT_NEAR(ms_of(found.clocks.at(sensor(2)).added), -30, 12);
}

TEST(Latencies, AreNotAskedForWithASigmaOfZero) {
  RegistrationConfig config;
  config.latency_sigma = Duration{0};
  EXPECT_TRUE(solve(late_ring({0, 50, 0}), kWalkStart, config).latencies.empty());
}

TEST(Latencies, TakenOffMakePlacesBetter) {
  const auto walk = late_ring({0, 80, 0});
  RegistrationConfig config;
  config.master = sensor(1);
  const auto off = [&](const Registration& found) {
    const auto& place = found.sensors.at(sensor(2)).world_from_sensor;
    const Eigen::Isometry3d exact = ring_place(deg(70)).inverse() * ring_place(deg(140));
    return difference(found.sensors.at(sensor(1)).world_from_sensor.inverse() * place, exact)
        .position;
  };
  const double with = off(solve(walk, kWalkStart, config));
  config.latency_sigma = Duration{0};
  EXPECT_LT(with, 0.8 * off(solve(walk, kWalkStart, config)));
}

TEST(PairLatency, OfSensorsThatSawNothingTogetherIsNone) {
  const Walker first = offset_walker(late_ring({0})[0], {});
  EXPECT_FALSE(pair_latency(first, Walker{}, Eigen::Isometry3d::Identity(), {}));
  EXPECT_FALSE(pair_latency(Walker{}, first, Eigen::Isometry3d::Identity(), {}));
}

}  // namespace
}  // namespace chorus::registration

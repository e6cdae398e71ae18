#include "common/synthetic/occluder.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/synthetic/sensor_model.h"

namespace chorus::synthetic {
namespace {

constexpr OccluderKind kPlank{"plank", 2.0, 0.5, 0.1};

TEST(Occluder, StandsOnItsFootAndTurnsAboutIt) {
  const Occluder plank = stand_thing(kPlank, {1, 0.2, 3}, deg(90));
  EXPECT_TRUE(plank.half.isApprox(Eigen::Vector3d(1, 0.25, 0.05)));
  const Eigen::Vector3d end = plank.world_from_box * Eigen::Vector3d(1, -0.25, 0);
  EXPECT_TRUE(end.isApprox(Eigen::Vector3d(1, 0.2, 2), 1e-9)) << end.transpose();
}

TEST(Occluder, GlidesToItsTravelsEndAndBack) {
  Occluder van = stand_thing(kOccluderKinds[0], {0, 0, 1}, 0.0);
  van.travel = {2, 0, 0};
  van.period = std::chrono::seconds(10);
  const auto x = [&](int s) { return place_of(van, std::chrono::seconds(s)).translation().x(); };
  EXPECT_NEAR(x(0), 0.0, 1e-9);
  EXPECT_NEAR(x(5), 2.0, 1e-9);
  EXPECT_NEAR(x(30), 0.0, 1e-9);
  EXPECT_NEAR(x(-5), 2.0, 1e-9);
}

TEST(HitBox, FaceEdgeMissInsideAndBehind) {
  const Eigen::Vector3d half(0.5, 1, 0.1);
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(hit_box(half, {0, 0, -3}, ahead).value(), 2.9, 1e-12);
  EXPECT_NEAR(hit_box(half, {0.49, -0.99, -3}, ahead).value(), 2.9, 1e-12);
  EXPECT_FALSE(hit_box(half, {0.51, 0, -3}, ahead));
  EXPECT_FALSE(hit_box(half, {0, 0, 3}, ahead)) << "behind";
  EXPECT_FALSE(hit_box(half, {0, 0, 0}, ahead)) << "inside";
  EXPECT_FALSE(hit_box(half, {std::nan(""), 0, -3}, ahead));
}

TEST(HitBox, WhatIsBehindAThingIsGuessedByThePlainSensorToo) {
  WalkerScript script;
  script.path = PathKind::Stand;
  Scene scene{Timestamp{}, make_people(script, 1), {stand_sensor({0, 1.6, -3}, 0, deg(13))}};
  SimulatedSensor sensor{SensorId::parse("s1").value(), 0, {}};
  const auto bodies = [&] { return observe(scene, sensor, 1'000'000)->bodies; };
  ASSERT_EQ(bodies().size(), 1u);
  EXPECT_EQ(bodies()[0].skeleton[JointId::AnkleLeft].state, JointState::Tracked);
  scene.occluders = {stand_thing(kOccluderKinds[2], {0, 0, -1}, 0.0)};
  ASSERT_EQ(bodies().size(), 1u) << "a table hides the legs only";
  EXPECT_EQ(bodies()[0].skeleton[JointId::AnkleLeft].state, JointState::Inferred);
  EXPECT_EQ(bodies()[0].skeleton[JointId::Head].state, JointState::Tracked);
  scene.occluders = {stand_thing(kOccluderKinds[1], {0, 0, -1.5}, 0.0)};
  EXPECT_TRUE(bodies().empty()) << "a pillar hides everybody behind it";
  scene.occluders = {stand_thing(kOccluderKinds[1], {0, 0, 1.5}, 0.0)};
  EXPECT_EQ(bodies().size(), 1u) << "it stands behind";
}

}  // namespace
}  // namespace chorus::synthetic

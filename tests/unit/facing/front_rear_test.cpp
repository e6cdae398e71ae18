#include "fusion-server/facing/front_rear.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::facing {
namespace {

/// A person at `neck` whose chest faces the sensor (along -z), turned by `yaw` about +y.
BodyFrame person(const Eigen::Vector3d& neck, double yaw) {
  BodyFrame body;
  const auto place = [&](JointId id, const Eigen::Vector3d& offset) {
    body.skeleton[id].position = neck + about_y(yaw) * offset;
    body.skeleton[id].state = JointState::Tracked;
  };
  place(JointId::Neck, {0, 0, 0});
  place(JointId::ShoulderLeft, {-0.2, -0.1, 0});  // when facing the sensor, left is at -x
  place(JointId::ShoulderRight, {0.2, -0.1, 0});
  return body;
}

TEST(StandingOf, APersonSquarelyBeforeTheSensor) {
  const Aspect standing = aspect_of(person({0, 0, 2.5}, 0));
  EXPECT_NEAR(standing.distance, 2.5, 1e-9);
  EXPECT_NEAR(standing.facing, 0.0, 1e-9);
  EXPECT_NEAR(standing.bearing, 0.0, 1e-9);
}

TEST(StandingOf, TurningIsFacing) {
  EXPECT_NEAR(std::abs(aspect_of(person({0, 0, 2.5}, deg(30))).facing), deg(30), 1e-9);
  EXPECT_NEAR(std::abs(aspect_of(person({0, 0, 2.5}, deg(120))).facing), deg(120), 1e-9);
}

TEST(StandingOf, StandingAsideIsBearing) {
  const Aspect standing = aspect_of(person({1.0, 0, 1.0}, 0));
  EXPECT_NEAR(std::abs(standing.bearing), deg(45), 1e-9);
  EXPECT_NEAR(std::abs(standing.facing), deg(45), 1e-9);
}

TEST(StandingOf, WhatCannotBeToldIsNaN) {
  const Aspect standing = aspect_of(BodyFrame{});
  EXPECT_TRUE(std::isnan(standing.distance));
  EXPECT_TRUE(std::isnan(standing.facing));
  EXPECT_TRUE(std::isnan(standing.bearing));
}

}  // namespace
}  // namespace chorus::facing

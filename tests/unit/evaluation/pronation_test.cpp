// A forearm's sensor turns by a share of what the hand turns.
#include "common/evaluation/pronation.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

const Eigen::Quaterniond kForearm = exp_map({0.4, -0.9, 0.3});

TEST(Pronation, TurnsTheForearmByAShareOfItsHandAboutTheBone) {
  for (const double turn : {-80.0, -5.0, 0.0, 40.0, 120.0}) {
    const Eigen::Quaterniond hand = kForearm * about_y(deg(turn));
    const Eigen::Quaterniond expected = kForearm * about_y(deg(0.7 * turn));
    EXPECT_LT(angular_distance(forearm_at_sensor(kForearm, hand), expected), 1e-9) << turn;
  }
}

TEST(Pronation, BendingTheWristIsNone) {
  const Eigen::Quaterniond bent = kForearm * exp_map({0.8, 0.0, 0.0});
  EXPECT_LT(angular_distance(forearm_at_sensor(kForearm, bent), kForearm), 1e-9);
  const Eigen::Quaterniond both = kForearm * about_y(deg(50)) * exp_map({0.0, 0.0, 0.5});
  EXPECT_LT(angular_distance(forearm_at_sensor(kForearm, both), kForearm * about_y(deg(35))), 1e-9);
}

TEST(Pronation, IsAboutTheBoneWhereverItPoints) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Quaterniond hand = kForearm * exp_map(deg(60) * x);
  const Eigen::Quaterniond expected = kForearm * exp_map(deg(42) * x);
  EXPECT_LT(angular_distance(forearm_at_sensor(kForearm, hand, x), expected), 1e-9);
  EXPECT_LT(angular_distance(forearm_at_sensor(kForearm, hand), kForearm), 1e-9);
}

TEST(Pronation, WhatNoWristDoesIsNone) {
  const Eigen::Quaterniond other_axes = kForearm * about_y(deg(178));
  EXPECT_EQ(angular_distance(forearm_at_sensor(kForearm, other_axes), kForearm), 0.0);
}

Skeleton<WorldSpace> stating(bool hand) {
  Skeleton<WorldSpace> body;
  for (const JointId id : {JointId::WristLeft, JointId::HandLeft, JointId::AnkleLeft}) {
    if (id == JointId::HandLeft && !hand) continue;
    body[id].state = JointState::Tracked;
    body[id].orientation = id == JointId::HandLeft ? kForearm * about_y(deg(90)) : kForearm;
  }
  return body;
}

TEST(LimbUnderSensor, IsTheForearmWithItsHandAndOtherLimbsAsStated) {
  const auto turned = limb_under_sensor(stating(true), Limb::ForearmLeft);
  ASSERT_TRUE(turned);
  EXPECT_NEAR(to_deg(angular_distance(turned->world_from_limb, kForearm)), 63.0, 1e-6);
  const auto alone = limb_under_sensor(stating(false), Limb::ForearmLeft);
  ASSERT_TRUE(alone);
  EXPECT_LT(angular_distance(alone->world_from_limb, kForearm), 1e-9);
  for (const Limb limb : {Limb::HandLeft, Limb::ShankLeft, Limb::ForearmRight}) {
    const auto one = limb_under_sensor(stating(true), limb);
    const auto stated = limb_from_orientation(stating(true), limb);
    ASSERT_EQ(one.has_value(), stated.has_value());
    if (!one) continue;
    EXPECT_EQ(one->world_from_limb.coeffs(), stated->world_from_limb.coeffs());
  }
}

}  // namespace
}  // namespace chorus::evaluation

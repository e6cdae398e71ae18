// What is seen of a limb beside what a worn sensor says of it, with sides as labelled and
// exchanged.
#include "common/evaluation/limb_fit.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

/// The left forearm raised ahead, the right one hangs.
Skeleton<WorldSpace> one_arm_up() {
  auto body = testing::standing_person();
  body[JointId::WristLeft].position =
      body[JointId::ElbowLeft].position + Eigen::Vector3d(0, 0, 0.25);
  body[JointId::WristRight].position =
      body[JointId::ElbowRight].position - Eigen::Vector3d(0, 0.25, 0);
  return body;
}

LimbSaid said_of(const Skeleton<WorldSpace>& body, Limb limb) {
  return {limb, limb_from_joints(body, limb)->world_from_limb, Eigen::Matrix3d::Zero()};
}

TEST(LimbFit, TellsALimbFromItsMirrorImage) {
  const auto fit = limb_fit(one_arm_up(), said_of(one_arm_up(), Limb::ForearmLeft));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->labelled, 0.0, 1e-6);
  EXPECT_EQ(fit->exchanged, kWorstFit) << "90 degrees off";
}

TEST(LimbFit, OfLimbsThatPointAlikeItTellsNothing) {
  const auto body = testing::standing_person();
  const auto fit = limb_fit(body, said_of(body, Limb::ShankRight));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->labelled, fit->exchanged, 0.2);
}

TEST(LimbFit, OfTheTrunkTheFrontCounts) {
  const auto body = testing::standing_person();
  for (const Limb limb : {Limb::Pelvis, Limb::Chest}) {
    const auto fit = limb_fit(body, said_of(body, limb));
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->labelled, 0.5) << name_of(limb);
    EXPECT_EQ(fit->exchanged, kWorstFit) << name_of(limb);
  }
  EXPECT_FALSE(limb_fit(body, {Limb::Head}));
}

TEST(LimbFit, WhatTheSensorKnowsBadlyHasLittleSay) {
  LimbSaid said = said_of(one_arm_up(), Limb::ForearmLeft);
  said.covariance = deg(90) * deg(90) * Eigen::Matrix3d::Identity();
  EXPECT_LT(limb_fit(one_arm_up(), said)->exchanged, 1.0);
  said.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(limb_fit(one_arm_up(), said));
}

TEST(LimbFit, WithoutDepthOnlyWhatLiesAcrossTheSightCounts) {
  const LimbSaid said = said_of(one_arm_up(), Limb::ForearmLeft);
  EXPECT_FALSE(limb_fit(one_arm_up(), said, Eigen::Vector3d::UnitZ())) << "it points along it";
  const auto beside = limb_fit(one_arm_up(), said, Eigen::Vector3d::UnitX());
  ASSERT_TRUE(beside);
  EXPECT_LT(beside->labelled, 0.1);
  EXPECT_EQ(beside->exchanged, kWorstFit);
}

TEST(LimbFit, OfWhatIsNotSeenThereIsNone) {
  auto body = one_arm_up();
  body[JointId::WristRight].state = JointState::NotTracked;
  EXPECT_FALSE(limb_fit(body, said_of(one_arm_up(), Limb::ForearmLeft)));
}

}  // namespace
}  // namespace chorus::evaluation

// Bone rotations from joint positions: the T-pose yields identities, and known turns yield known
// rotations.
#include "fusion-server/outlet/humanoid.h"

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::outlet {
namespace {

using namespace testing;  // poses
using chorus::testing::RotationNear;
using chorus::testing::VectorNear;
using enum HumanBone;
using Quaternion = Eigen::Quaterniond;

constexpr double kExact = 1e-6;

Quaternion local(const Humanoid& rig, HumanBone bone) {
  return rig[parent_of(bone)].world_from_bone.conjugate() * rig[bone].world_from_bone;
}

/// Expects each bone's own rotation to be the one in `turned`, or the identity if there is none.
void expect_only(const Humanoid& rig, const std::map<HumanBone, Quaternion>& turned) {
  for (std::size_t i = 1; i < kHumanBoneCount; ++i) {
    const auto bone = static_cast<HumanBone>(i);
    const auto found = turned.find(bone);
    const Quaternion expected = found == turned.end() ? Quaternion::Identity() : found->second;
    EXPECT_THAT(local(rig, bone), RotationNear(expected, kExact)) << kHumanBoneNames[i];
    EXPECT_TRUE(rig[bone].known) << kHumanBoneNames[i];
  }
}

TEST(Humanoid, ATPoseIsAllIdentities) {
  const Humanoid rig = humanoid_of(t_pose());
  EXPECT_TRUE(rig[Hips].known);
  EXPECT_THAT(rig[Hips].world_from_bone, RotationNear(Quaternion::Identity(), kExact));
  expect_only(rig, {});
}

TEST(Humanoid, ABodyThatTurnsTurnsItsHipsOnly) {
  TrackerBody body = t_pose();
  move(body, {1, 2, 3}, 130);
  const Humanoid rig = humanoid_of(body);
  EXPECT_THAT(rig[Hips].world_from_bone, RotationNear(about_up(130), kExact));
  EXPECT_THAT(rig[Hips].origin, VectorNear(Eigen::Vector3d(1, 2.95, 3), kExact));
  expect_only(rig, {});
}

TEST(Humanoid, ArmsDownAreAQuarterTurnAboutTheForwardAxis) {
  TrackerBody body = t_pose();
  turn(body, kLeftArm, JointId::ShoulderLeft, about_z(90));
  turn(body, kRightArm, JointId::ShoulderRight, about_z(-90));
  expect_only(humanoid_of(body), {{LeftUpperArm, about_z(90)}, {RightUpperArm, about_z(-90)}});
}

TEST(Humanoid, AForearmThatPointsForwardTurnsAboutTheUpAxis) {
  TrackerBody body = t_pose();
  turn(body, kLeftForearm, JointId::ElbowLeft, about_up(-90));
  expect_only(humanoid_of(body), {{LeftLowerArm, about_up(-90)}});
}

TEST(Humanoid, TheBentElbowSaysHowTheUpperArmIsTwisted) {
  TrackerBody body = t_pose();  // hand up, elbow at shoulder height
  turn(body, kLeftArm, JointId::ShoulderLeft, about_x(90));
  turn(body, kLeftForearm, JointId::ElbowLeft, about_z(-90));
  ASSERT_GT(body[JointId::HandLeft].position.y(), 1.6);
  expect_only(humanoid_of(body), {{LeftUpperArm, about_x(90)}, {LeftLowerArm, about_up(-90)}});
}

/// The left arm's limb axes at rest: +y along the bone, +x the axis of the elbow.
Quaternion left_arm_at_rest() {
  Eigen::Matrix3d axes;
  axes << -Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ();
  return Quaternion(axes);
}

TEST(Humanoid, AWornSensorSaysHowAStraightArmIsTwisted) {
  TrackerBody body = t_pose();
  const Quaternion twist = about(-Eigen::Vector3d::UnitX(), 40);
  TrackerJoint& elbow = body.joints[index_of(JointId::ElbowLeft)];
  elbow.orientation = twist * left_arm_at_rest();
  elbow.twist_measured = true;
  expect_only(humanoid_of(body), {{LeftUpperArm, twist}, {LeftHand, twist.conjugate()}});
  TrackerJoint& wrist = body.joints[index_of(JointId::WristLeft)];
  wrist.orientation = left_arm_at_rest();
  wrist.twist_measured = true;
  expect_only(humanoid_of(body), {{LeftUpperArm, twist}, {LeftLowerArm, twist.conjugate()}});
  elbow.twist_measured = wrist.twist_measured = false;
  expect_only(humanoid_of(body), {});
}

TEST(Humanoid, AKneeBendsBackwards) {
  TrackerBody body = t_pose();
  turn(body, {JointId::KneeRight, JointId::AnkleRight, JointId::FootRight}, JointId::HipRight,
       about_x(50));
  turn(body, {JointId::AnkleRight, JointId::FootRight}, JointId::KneeRight, about_x(-80));
  expect_only(humanoid_of(body), {{RightUpperLeg, about_x(50)}, {RightLowerLeg, about_x(-80)}});
}

TEST(Humanoid, TheThumbSaysHowTheHandIsTwisted) {
  TrackerBody body = t_pose();
  turn(body, {JointId::ThumbLeft}, JointId::WristLeft, about_x(60));
  expect_only(humanoid_of(body), {{LeftHand, about_x(60)}});
}

TEST(Humanoid, TheHeadTurnsAsItsOrientationTurnsAgainstTheShoulders) {
  TrackerBody body = t_pose();
  for (TrackerJoint& joint : body.joints) joint.orientation = about_up(17);  // to be ignored
  body.joints[index_of(JointId::Head)].orientation = about_up(40) * about_up(17);
  expect_only(humanoid_of(body), {{Head, about_up(40)}});
}

TEST(Humanoid, BonesPointAlongTheirJointsInAnyPose) {
  const TrackerBody body = asymmetric_pose();
  const Humanoid rig = humanoid_of(body);
  struct Lies {
    HumanBone bone;
    JointId from, to;
    Eigen::Vector3d rest;
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  for (const Lies& lies : {Lies{Spine, JointId::SpineBase, JointId::SpineMid, y},
                           Lies{Chest, JointId::SpineMid, JointId::SpineShoulder, y},
                           Lies{LeftUpperArm, JointId::ShoulderLeft, JointId::ElbowLeft, -x},
                           Lies{LeftLowerArm, JointId::ElbowLeft, JointId::WristLeft, -x},
                           Lies{RightUpperArm, JointId::ShoulderRight, JointId::ElbowRight, x},
                           Lies{RightHand, JointId::WristRight, JointId::HandTipRight, x},
                           Lies{LeftUpperLeg, JointId::HipLeft, JointId::KneeLeft, -y},
                           Lies{RightLowerLeg, JointId::KneeRight, JointId::AnkleRight, -y}}) {
    const Eigen::Vector3d along = (body[lies.to].position - body[lies.from].position).normalized();
    EXPECT_THAT(rig[lies.bone].world_from_bone * lies.rest, VectorNear(along, kExact))
        << kHumanBoneNames[static_cast<std::size_t>(lies.bone)];
  }
  EXPECT_THAT(rig[Hips].world_from_bone, RotationNear(about_up(30), 0.3));
}

TEST(Humanoid, AStraightLimbTakesTheShortestTurnAndABendingOneDoesNotJump) {
  double largest = 0.0;
  Quaternion before = Quaternion::Identity();
  for (double angle = 0; angle <= 60; angle += 0.5) {
    // The elbow bends upwards, and the upper arm twists by up to 90 deg.
    TrackerBody body = t_pose();
    turn(body, kLeftForearm, JointId::ElbowLeft, about_z(-angle));
    const Quaternion now = humanoid_of(body)[LeftUpperArm].world_from_bone;
    largest = std::max(largest, angular_distance(before, now));
    before = now;
  }
  EXPECT_LT(largest, deg(10));
  EXPECT_THAT(before, RotationNear(about_x(90), kExact));
}

TEST(Humanoid, WhatIsNotTrackedIsNotKnownAndNothingIsNotANumber) {
  TrackerBody body = asymmetric_pose();
  for (const JointId id : {JointId::ElbowLeft, JointId::HandRight, JointId::HandTipRight,
                           JointId::ThumbRight, JointId::AnkleRight}) {
    body.joints[index_of(id)].tracked = false;
    body.joints[index_of(id)].position.setConstant(std::nan(""));
  }
  const Humanoid rig = humanoid_of(body);
  for (const HumanBone lost : {LeftUpperArm, LeftLowerArm, RightHand, RightLowerLeg, RightFoot}) {
    EXPECT_FALSE(rig[lost].known) << static_cast<int>(lost);
  }
  for (const HumanBone kept : {LeftHand, RightLowerArm, RightUpperLeg, Head, RightToes}) {
    EXPECT_TRUE(rig[kept].known) << static_cast<int>(kept);
  }
  for (const BonePose& bone : rig.bones) {
    EXPECT_TRUE(bone.origin.allFinite() && bone.world_from_bone.coeffs().allFinite());
  }
}

TEST(Humanoid, NobodyKnowsWhereABodyFacesWithoutHipsAndShoulders) {
  TrackerBody body = t_pose();
  body.joints[index_of(JointId::HipLeft)].tracked = false;
  EXPECT_TRUE(humanoid_of(body)[Hips].known);
  body.joints[index_of(JointId::ShoulderRight)].tracked = false;
  const Humanoid rig = humanoid_of(body);
  for (const BonePose& bone : rig.bones) EXPECT_FALSE(bone.known);
}

TEST(Humanoid, JointsOnOneSpotAreNoDirection) {
  TrackerBody body;
  for (TrackerJoint& joint : body.joints) joint.tracked = true;
  EXPECT_FALSE(humanoid_of(body)[Hips].known);
}

}  // namespace
}  // namespace chorus::outlet

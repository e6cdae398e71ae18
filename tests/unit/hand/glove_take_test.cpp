// A glove's take, and a hand placed by the joints that a network sees.
#include "common/hand/glove_take.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/hand/glove_joints.h"
#include "tests/support/hands/glove_scene.h"
#include "tests/support/matchers.h"

namespace chorus::hand {
namespace {

using chorus::testing::usual_skeleton;
using testing::FailsWith;

Pose turned_pose(double angle) {
  Pose out;
  out.wrist = {angle, 1.0, 0.5};
  out.turn = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized());
  out.local[hand_joint(2, 1)] = Eigen::AngleAxisd(0.5 * angle, Eigen::Vector3d::UnitX());
  return out;
}

TEST(AGlovesTake, IsReadAsItWasWritten) {
  const std::array poses{turned_pose(0.2), turned_pose(0.6)};
  const auto take = read_glove_take(bvh_of(usual_skeleton(), poses, 50.0), "take.bvh", Side::Right);
  ASSERT_TRUE(take) << to_string(take.error());
  EXPECT_NEAR(take->rate_hz, 50.0, 1e-3);
  ASSERT_EQ(take->poses.size(), 2U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(take->poses[i].turn.angularDistance(poses[i].turn), 1e-5);
    EXPECT_LT(
        take->poses[i].local[hand_joint(2, 1)].angularDistance(poses[i].local[hand_joint(2, 1)]),
        1e-5);
    EXPECT_LT((take->poses[i].wrist - poses[i].wrist).norm(), 1e-5);
  }
  const Pose between = pose_at(*take, 0.01);
  EXPECT_NEAR(between.turn.angularDistance(poses[0].turn), 0.2, 1e-4);
  EXPECT_LT(pose_at(*take, 99.0).turn.angularDistance(poses[1].turn), 1e-5);
  EXPECT_LT(pose_at(*take, std::nan("")).turn.angularDistance(poses[0].turn), 1e-5);
}

TEST(AGlovesTake, OfAHandOnABodyCountsItsParents) {
  const std::string body = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  JOINT LeftHand
  {
    OFFSET 10 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 5 0
    }
  }
}
MOTION
Frames: 1
Frame Time: 0.02
90 0 0 0 0 90
)";
  const auto take = read_glove_take(body, "body.bvh", Side::Left);
  ASSERT_TRUE(take) << to_string(take.error());
  const Eigen::Quaterniond z(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ())),
      y(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  EXPECT_LT(take->poses[0].turn.angularDistance(z * y), 1e-6);
  EXPECT_NEAR(take->poses[0].wrist.y(), 0.1, 1e-9);
  EXPECT_THAT(read_glove_take(body, "body.bvh", Side::Right), FailsWith(ErrorCode::NotFound));
}

/// What a network would see: the joints, each `off` pixels away.
Joints seen_joints(const PosedGlove& glove, const Eigen::Vector3d& wrist, double off) {
  const Intrinsics camera{640, 480, 600.0, 600.0, 319.5, 239.5, {}};
  Pose pose = glove.pose;
  pose.wrist = wrist;
  Joints out;
  const auto joints = joints_of(glove.skeleton, pose);
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    out[i] = {camera.cx + camera.fx * joints[i].x() / joints[i].z() + (i % 2 == 0 ? off : -off),
              camera.cy + camera.fy * joints[i].y() / joints[i].z()};
  }
  return out;
}

TEST(AHandWhoseJointsAreSeen, IsPlacedOnTheirRays) {
  const Intrinsics camera{640, 480, 600.0, 600.0, 319.5, 239.5, {}};
  const PosedGlove glove{usual_skeleton(), turned_pose(0.4)};
  const Eigen::Vector3d wrist(0.05, -0.1, 0.7);
  const auto exact = place_by_joints(seen_joints(glove, wrist, 0.0), glove, camera);
  ASSERT_TRUE(exact) << to_string(exact.error());
  EXPECT_LT((exact->wrist - wrist).norm(), 1e-6);
  Joints misplaced = seen_joints(glove, wrist, 1.0);
  misplaced[hand_joint(4, 3)] += Pixel(80.0, 0.0);
  const auto place = place_by_joints(misplaced, glove, camera);
  ASSERT_TRUE(place);
  EXPECT_LT((place->wrist - wrist).norm(), 0.01) << "one joint is misplaced by 80 pixels";
  EXPECT_GT(place->covariance(2, 2), place->covariance(0, 0)) << "depth is the least certain";
}

TEST(AHandWhoseJointsAreSeen, ButPosedOtherwiseIsRefused) {
  const Intrinsics camera{640, 480, 600.0, 600.0, 319.5, 239.5, {}};
  const PosedGlove glove{usual_skeleton(), turned_pose(0.4)};
  Joints mirrored = seen_joints(glove, {0.05, -0.1, 0.7}, 0.0);
  for (Pixel& each : mirrored) each = 2.0 * mirrored[0] - each;
  EXPECT_THAT(place_by_joints(mirrored, glove, camera), FailsWith(ErrorCode::NotFound));
  PosedGlove none = glove;
  none.pose.turn.coeffs().setConstant(std::nan(""));
  EXPECT_THAT(place_by_joints(mirrored, none, camera), FailsWith(ErrorCode::InvalidArgument));
}

}  // namespace
}  // namespace chorus::hand

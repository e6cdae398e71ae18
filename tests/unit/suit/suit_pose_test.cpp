#include "common/suit/suit_pose.h"

#include <gtest/gtest.h>

#include "common/motion/cmu_walk.h"
#include "common/suit/suit_file.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::suit {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::VectorNear;

TEST(SuitPose, HasNoPlaceAndComesBackWhereItIsPut) {
  const Skeleton<WorldSpace> body = chorus::testing::standing_person({1, 0, 2}, 0.5);
  const SuitPose pose = pose_of(body, Duration{0});
  EXPECT_EQ(pose.joints[JointId::SpineBase].position.norm(), 0.0);
  const Skeleton<WorldSpace> back = placed(pose, 0.0, body[JointId::SpineBase].position);
  for (std::size_t i = 0; i < kJointCount; ++i)
    EXPECT_THAT(back.joints[i].position, VectorNear(body.joints[i].position, 1e-12));
}

TEST(SuitPose, IsTurnedByAHeading) {
  const SuitPose pose = pose_of(chorus::testing::standing_person(), Duration{0});
  const Skeleton<WorldSpace> turned = placed(pose, 1.0, {0, 0, 0});
  const SuitPose asked = pose_of(chorus::testing::standing_person({0, 0, 0}, 1.0), Duration{0});
  EXPECT_THAT(turned[JointId::HandLeft].position,
              VectorNear(asked.joints[JointId::HandLeft].position, 1e-9));
}

TEST(SuitPose, IsScaledToTheStature) {
  const motion::CmuWalk& walk = motion::cmu_walk();
  const auto motion = motion::motion_from_amc(walk.skeleton, walk.takes.front());
  ASSERT_THAT(motion, IsOk());
  const auto take = take_of(*motion, 1.60);
  ASSERT_THAT(take, IsOk());
  EXPECT_NEAR(stature_of(take->poses.front()), 1.60, 0.01);
}

TEST(SuitPose, ASuitThatDoesNotMoveIsRefused) {
  motion::Motion still;
  still.rate_hz = 60.0;
  still.frames.assign(200, chorus::testing::standing_person());
  EXPECT_THAT(take_of(still, 0.0), FailsWith(ErrorCode::InvalidArgument));
}

TEST(SuitPose, ATakeWithoutLegsIsRefused) {
  motion::Motion motion;
  motion.rate_hz = 60.0;
  motion.frames.assign(10, chorus::testing::standing_person());
  for (auto& body : motion.frames) chorus::testing::hide(body[JointId::AnkleRight]);
  EXPECT_THAT(take_of(motion, 0.0), FailsWith(ErrorCode::Unsupported));
}

TEST(SuitPose, BetweenTwoInstantsIsInterpolated) {
  SuitTake take;
  take.poses = {pose_of(chorus::testing::standing_person(), Duration{0}),
                pose_of(chorus::testing::t_pose_person(), from_seconds(1.0))};
  const SuitPose half = pose_at(take, from_seconds(0.5));
  const Eigen::Vector3d mean = 0.5 * (take.poses[0].joints[JointId::WristLeft].position +
                                      take.poses[1].joints[JointId::WristLeft].position);
  EXPECT_THAT(half.joints[JointId::WristLeft].position, VectorNear(mean, 1e-9));
  EXPECT_FALSE(pose_at({}, Duration{0}).joints[JointId::SpineBase].seen());
}

TEST(SuitFile, OfAnotherKindIsRefusedByName) {
  EXPECT_THAT(read_suit_file("walk.fbx"), FailsWith(ErrorCode::Unsupported));
  EXPECT_THAT(read_suit_file("/nowhere/walk.bvh"), FailsWith(ErrorCode::NotFound));
}

}  // namespace
}  // namespace chorus::suit

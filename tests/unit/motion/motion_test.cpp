#include "common/motion/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/motion/cmu_walk.h"

namespace chorus::motion {
namespace {

Motion take(std::size_t index) {
  return motion_from_amc(cmu_walk().skeleton, cmu_walk().takes.at(index)).value();
}

class Walk : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Walk, BonesKeepTheirLength) {
  const Motion motion = take(GetParam());
  for (const Bone& bone : kBones) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (const auto& body : motion.frames) {
      const double length = (body[bone.child].position - body[bone.parent].position).norm();
      least = std::min(least, length);
      most = std::max(most, length);
    }
    EXPECT_LT(most - least, 0.004) << name_of(bone.child);
    EXPECT_GT(least, 0.05) << name_of(bone.child);
    EXPECT_LT(most, 0.5) << name_of(bone.child);
  }
}

TEST_P(Walk, LeftIsLeftOfTheWayWalked) {
  const Motion motion = take(GetParam());
  const Eigen::Vector3d way = motion.frames.back()[JointId::SpineBase].position -
                              motion.frames.front()[JointId::SpineBase].position;
  EXPECT_GT(way.norm(), 3.0) << "two seconds and more of walking";
  const Eigen::Vector3d to_left = Eigen::Vector3d::UnitY().cross(way.normalized());
  Eigen::Vector3d toes = Eigen::Vector3d::Zero();
  for (const auto& body : motion.frames) {
    for (const MirrorPair& pair : {kMirrorPairs[0], kMirrorPairs[6]}) {  // shoulders, hips
      const Eigen::Vector3d across = body[pair.left].position - body[pair.right].position;
      EXPECT_GT(across.dot(to_left), 0.15);
    }
    toes += body[JointId::FootLeft].position - body[JointId::AnkleLeft].position;
  }
  EXPECT_GT(toes.normalized().dot(way.normalized()), 0.7)
      << "toes point where the person walks, except at push-off";
}

TEST_P(Walk, StandsOnTheFloorAndHasHumanSize) {
  for (const auto& body : take(GetParam()).frames) {
    const double lowest =
        std::min(body[JointId::FootLeft].position.y(), body[JointId::FootRight].position.y());
    EXPECT_NEAR(lowest, 0.03, 0.06);
    EXPECT_NEAR(body[JointId::Head].position.y(), 1.55, 0.12);
    EXPECT_NEAR(body[JointId::SpineBase].position.y(), 0.88, 0.08);
  }
}

TEST_P(Walk, NothingJumps) {
  const Motion motion = take(GetParam());
  for (std::size_t i = 1; i < motion.frames.size(); ++i) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const double step =
          (motion.frames[i].joints[j].position - motion.frames[i - 1].joints[j].position).norm();
      EXPECT_LT(step * motion.rate_hz, 7.0) << kJointNames[j] << " at " << i;  // [m/s]
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Takes, Walk, ::testing::Values(0, 1));

TEST(Orientation, YPointsAlongTheBoneAndLeavesHaveNone) {
  const auto body = take(0).frames[50];
  for (const Bone& bone : kBones) {
    const Joint& child = body[bone.child];
    if (!is_unit(child.orientation)) continue;
    const Eigen::Vector3d along = (child.position - body[bone.parent].position).normalized();
    EXPECT_NEAR((child.orientation * Eigen::Vector3d::UnitY()).dot(along), 1.0, 1e-9)
        << name_of(bone.child);
  }
  EXPECT_TRUE(is_unit(body[JointId::SpineBase].orientation));
  EXPECT_GT((body[JointId::SpineMid].orientation * Eigen::Vector3d::UnitZ()).z(), 0.9)
      << "the trunk's +z is the body's forward";
  EXPECT_FALSE(is_unit(body[JointId::Head].orientation));
  EXPECT_FALSE(is_unit(body[JointId::FootLeft].orientation));
}

TEST(At, InterpolatesAndHoldsTheEnds) {
  const Motion motion = take(0);
  const auto half = at(motion, 10.5 / motion.rate_hz)[JointId::Head].position;
  const Eigen::Vector3d expected =
      0.5 * (motion.frames[10][JointId::Head].position + motion.frames[11][JointId::Head].position);
  EXPECT_TRUE(half.isApprox(expected, 1e-12));
  EXPECT_EQ(at(motion, -5)[JointId::Head].position, motion.frames.front()[JointId::Head].position);
  EXPECT_EQ(at(motion, 500)[JointId::Head].position, motion.frames.back()[JointId::Head].position);
  EXPECT_TRUE(at(motion, std::nan(""))[JointId::Head].position.allFinite());
  EXPECT_FALSE(at(Motion{}, 1.0)[JointId::Head].seen());
}

}  // namespace
}  // namespace chorus::motion

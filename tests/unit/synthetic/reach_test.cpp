#include "common/synthetic/reach.h"

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "common/synthetic/gait.h"

namespace chorus::synthetic {
namespace {

using enum JointId;

Skeleton<WorldSpace> standing() { return Gait::built_in(0).pose(0.0, 0.0); }

TEST(Reach, TheWristArrivesAndBonesKeepTheirLength) {
  const auto before = standing();
  for (const bool left : {true, false}) {
    const double side = left ? 1 : -1;
    auto body = before;
    const Eigen::Vector3d target(side * 0.2, 1.2, 0.4);
    apply({left, 1.0, target}, body);
    EXPECT_TRUE(body[left ? WristLeft : WristRight].position.isApprox(target, 1e-9));
    for (const Bone& bone : kBones) {
      EXPECT_NEAR((body[bone.child].position - body[bone.parent].position).norm(),
                  (before[bone.child].position - before[bone.parent].position).norm(), 1e-9)
          << name_of(bone.child);
    }
    EXPECT_EQ(body[left ? WristRight : WristLeft].position,
              before[left ? WristRight : WristLeft].position);
    EXPECT_LT(body[left ? ElbowLeft : ElbowRight].position.y(), 1.3) << "the elbow hangs";
  }
}

TEST(Reach, WhatIsTooFarAwayIsReachedFor) {
  auto body = standing();
  apply({true, 1.0, {0.2, 1.4, 5.0}}, body);
  const Eigen::Vector3d arm = body[WristLeft].position - body[ShoulderLeft].position;
  EXPECT_LT(arm.norm(), 0.57);
  EXPECT_GT(arm.normalized().z(), 0.99) << "straight towards it";
}

TEST(Reach, BeginsWhereTheArmWas) {
  const auto before = standing();
  auto body = before;
  apply({true, 0.0, {0.2, 1.4, 0.4}}, body);
  EXPECT_EQ(body[WristLeft].position, before[WristLeft].position);
  apply({true, 0.001, {0.2, 1.4, 0.4}}, body);
  EXPECT_LT((body[WristLeft].position - before[WristLeft].position).norm(), 0.01);
  EXPECT_LT((body[ElbowLeft].position - before[ElbowLeft].position).norm(), 0.01);
}

}  // namespace
}  // namespace chorus::synthetic

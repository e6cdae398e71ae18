// Somebody who exercises is the same body in other poses.
#include "common/synthetic/exercise.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::synthetic {
namespace {

using enum JointId;

constexpr double kAt = 12.3;  // [s]

TEST(SomebodyWhoExercises, HasTheSameBones) {
  const Person walker = make_people({}, 1).front();
  const Person exerciser = exercising(walker);
  for (double t = 0.0; t < 20.0; t += 0.7) {
    const auto before = walker(from_seconds(t));
    const auto after = exerciser(from_seconds(t));
    for (const Bone& bone : kBones) {
      const auto length = [&](const Skeleton<WorldSpace>& pose) {
        return (pose[bone.child].position - pose[bone.parent].position).norm();
      };
      EXPECT_NEAR(length(before), length(after), 1e-9) << name_of(bone.child);
    }
    EXPECT_EQ(before[SpineBase].position, after[SpineBase].position);
  }
}

TEST(SomebodyWhoExercises, TurnsOrientationsWithTheBones) {
  const Skeleton<WorldSpace> before = make_people({}, 1).front()(from_seconds(kAt));
  const Skeleton<WorldSpace> after = exercised(before, from_seconds(kAt));
  for (const Bone bone :
       {Bone{ElbowLeft, WristLeft}, Bone{HipRight, KneeRight}, Bone{KneeLeft, AnkleLeft}}) {
    // The bone as its own orientation sees it.
    const auto own = [&](const Skeleton<WorldSpace>& pose) {
      return Eigen::Vector3d(pose[bone.child].orientation.conjugate() *
                             (pose[bone.child].position - pose[bone.parent].position));
    };
    EXPECT_LT((own(before) - own(after)).norm(), 1e-9) << name_of(bone.child);
    EXPECT_GT((before[bone.child].position - after[bone.child].position).norm(), 0.02);
  }
}

TEST(SomebodyWhoExercises, MovesEveryLimbAboutMoreThanOneAxis) {
  const Person exerciser = exercising(make_people({}, 1).front());
  for (const JointId joint :
       {SpineBase, SpineShoulder, ElbowLeft, WristRight, KneeLeft, AnkleRight}) {
    // Largest spread of each axis' direction relative to the body's own heading.
    Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
    Eigen::Quaterniond first = Eigen::Quaterniond::Identity();
    for (int i = 0; i < 100; ++i) {
      const Eigen::Quaterniond now = exerciser(from_seconds(0.2 * i))[joint].orientation;
      if (i == 0) first = now;
      const Eigen::Vector3d turned = log_map(first.conjugate() * now);
      sums += turned * turned.transpose() / 100.0;
    }
    const Eigen::Vector3d spread =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sums).eigenvalues();
    EXPECT_GT(std::sqrt(spread(1)), 0.1) << name_of(joint);
  }
}

}  // namespace
}  // namespace chorus::synthetic

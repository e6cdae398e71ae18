#include "fusion-server/registration/adjoint.h"

#include <gtest/gtest.h>

#include "tests/unit/registration/pair_cloud.h"

namespace chorus::registration {
namespace {

constexpr double kAdjointStep = 1e-6;
const Eigen::Isometry3d kB = tilted_motion();
const Eigen::Isometry3d kA = some_motion(-0.7);

TEST(Adjoint, EqualsTheNumericJacobianOfCarryingAMotionAcross) {
  Matrix6 numeric;
  for (int axis = 0; axis < 6; ++axis) {
    numeric.col(axis) = (motion_of(kB * small_motion(unit6(axis, kAdjointStep)) * kB.inverse()) -
                         motion_of(kB * small_motion(unit6(axis, -kAdjointStep)) * kB.inverse())) /
                        (2.0 * kAdjointStep);
  }
  EXPECT_LT((adjoint(kB) - numeric).norm(), 1e-8);
}

TEST(Adjoint, FollowsProductsAndInverses) {
  EXPECT_LT((adjoint(kA * kB) - adjoint(kA) * adjoint(kB)).norm(), 1e-12);
  EXPECT_LT((adjoint(kB.inverse()) * adjoint(kB) - Matrix6::Identity()).norm(), 1e-12);
  EXPECT_EQ(adjoint(Eigen::Isometry3d::Identity()), Matrix6::Identity());
}

TEST(AtPoint, EqualsTheNumericJacobianOfThePointsDisplacement) {
  const Eigen::Vector3d x(0.4, -1.3, 2.2);
  Matrix6 numeric = Matrix6::Zero();
  for (int axis = 0; axis < 6; ++axis) {
    const Eigen::Vector3d ahead = small_motion(unit6(axis, kAdjointStep)) * x;
    const Eigen::Vector3d back = small_motion(unit6(axis, -kAdjointStep)) * x;
    numeric.block<3, 1>(3, axis) = (ahead - back) / (2.0 * kAdjointStep);
  }
  numeric.topLeftCorner<3, 3>().setIdentity();  // the rotation itself does not change
  EXPECT_LT((at_point(x) - numeric).norm(), 1e-8);
}

TEST(AtPoint, UndoesItselfAtTheOppositePointAndIsNothingAtTheOrigin) {
  const Eigen::Vector3d x(1, 2, 3);
  EXPECT_EQ(at_point(x) * at_point(-x), Matrix6::Identity());
  EXPECT_EQ(at_point(Eigen::Vector3d::Zero()), Matrix6::Identity());
}

}  // namespace
}  // namespace chorus::registration

#include "fusion-server/registration/floor_prior.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/unit/registration/pair_cloud.h"

namespace chorus::registration {
namespace {

constexpr double kPriorStep = 1e-6;
const FloorPrior kPrior{0.02, 0.03};
const Eigen::Vector3d kCentre(0.4, 1.1, 2.6);

/// The prior's residuals, in sigmas: two tilts of the up direction and one height.
Eigen::Vector3d misfit(const Eigen::Isometry3d& target_from_source, const FloorPrior& prior) {
  const Eigen::Vector3d up = target_from_source.linear().col(1);
  const Eigen::Vector3d foot = target_from_source * Eigen::Vector3d(kCentre.x(), 0, kCentre.z());
  return {up.x() / prior.tilt, up.z() / prior.tilt, foot.y() / prior.height};
}

Normal numeric_normal(const Eigen::Isometry3d& at) {
  Eigen::Matrix<double, 3, 6> jacobian;
  for (int axis = 0; axis < 6; ++axis) {
    jacobian.col(axis) = (misfit(small_motion(unit6(axis, kPriorStep)) * at, kPrior) -
                          misfit(small_motion(unit6(axis, -kPriorStep)) * at, kPrior)) /
                         (2.0 * kPriorStep);
  }
  Normal normal;
  normal.information = jacobian.transpose() * jacobian;
  normal.right = -jacobian.transpose() * misfit(at, kPrior);
  return normal;
}

TEST(FloorPrior, EquationsAreThoseOfTheNumericJacobian) {
  const Eigen::Isometry3d at = tilted_motion();
  Normal analytic;
  add_prior(analytic, kPrior, at, kCentre);
  const Normal numeric = numeric_normal(at);
  EXPECT_LT((analytic.information - numeric.information).norm(), 1e-6 * numeric.information.norm());
  EXPECT_LT((analytic.right - numeric.right).norm(), 1e-6 * numeric.right.norm());
}

TEST(FloorPrior, StandsATiltedFrameUprightOnTheFloor) {
  Eigen::Isometry3d at = some_motion() * small_motion(unit6(0, 0.1) + unit6(4, 0.2));
  for (int i = 0; i < 10; ++i) {
    Normal normal;
    add_prior(normal, kPrior, at, kCentre);
    normal.information += 1e-9 * Matrix6::Identity();  // yaw, horizontal place: undetermined
    at = small_motion(normal.information.ldlt().solve(normal.right)) * at;
  }
  EXPECT_LT(misfit(at, kPrior).norm(), 1e-6);
}

TEST(FloorPrior, SaysNothingOfYawAndOfTheHorizontalPlace) {
  Normal normal;
  add_prior(normal, kPrior, some_motion(), kCentre);
  EXPECT_EQ(normal.right, Vector6::Zero());
  const Eigen::Vector3d foot = some_motion() * Eigen::Vector3d(kCentre.x(), 0, kCentre.z());
  Vector6 about_the_foot = unit6(1, 1.0);
  about_the_foot.tail<3>() = foot.cross(Eigen::Vector3d::UnitY());
  EXPECT_LT((normal.information * about_the_foot).norm(), 1e-9);
  EXPECT_LT((normal.information * unit6(3, 1.0)).norm(), 1e-9);
  EXPECT_LT((normal.information * unit6(5, 1.0)).norm(), 1e-9);
}

TEST(FloorPrior, EitherHalfCanBeLeftOut) {
  Normal tilt_only;
  add_prior(tilt_only, {0.02, 0.0}, tilted_motion(), kCentre);
  EXPECT_EQ(tilt_only.information.bottomRightCorner(3, 3).norm(), 0.0);
  EXPECT_GT(tilt_only.right.norm(), 0.0);
  Normal height_only;
  add_prior(height_only, {0.0, 0.03}, tilted_motion(), kCentre);
  EXPECT_NEAR(height_only.information(4, 4), 1.0 / (0.03 * 0.03), 1e-9);
  Normal neither;
  add_prior(neither, {}, tilted_motion(), kCentre);
  EXPECT_EQ(neither.information, Matrix6::Zero());
  EXPECT_EQ(neither.right, Vector6::Zero());
}

TEST(FloorPrior, OfTwoFloorsIsSqrtTwoWiderThanOfOne) {
  EXPECT_NEAR(to_deg(kTwoFloors.tilt), 0.4 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(to_mm(kTwoFloors.height), 10.0 * std::sqrt(2.0), 1e-12);
}

TEST(Normal, AddsOneWeightedRow) {
  Normal normal;
  Row6 row;
  row << 1, 2, 3, 4, 5, 6;
  normal.add(row, -0.5, 4.0);
  normal.add(row, 1.0, 1.0);
  EXPECT_EQ(normal.information, Matrix6(5.0 * row.transpose() * row));
  EXPECT_EQ(normal.right, Vector6(-1.0 * row.transpose()));
}

}  // namespace
}  // namespace chorus::registration

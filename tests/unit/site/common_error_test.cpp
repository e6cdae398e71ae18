#include "fusion-server/site/common_error.h"

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"

namespace chorus::site {
namespace {

CellPlace place_at(double x, double z, double sigma) {
  CellPlace place;
  place.site_from_cell.translation() = Eigen::Vector3d(x, 0, z);
  place.covariance.setZero();
  place.covariance(1, 1) = deg(1) * deg(1);
  place.covariance(3, 3) = place.covariance(5, 5) = sigma * sigma;
  place.clock_sigma = std::chrono::milliseconds(20);
  return place;
}

TEST(CommonErrors, AreLearnedFromPeopleSeenByBoth) {
  const CommonError before = stated_error(place_at(0, 0, 0.2), place_at(6, 0, 0.2), {});
  // The other cell stands 0.2 m aside and is turned by 2 degrees, and its clock is 50 ms late.
  const Eigen::Vector4d truth(0.2, -0.1, deg(2), 0.05);
  CommonError error = before;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector2d at(3.0 + std::cos(i), std::sin(i) * 2.0);
    const Eigen::Vector2d velocity(1.2 * std::sin(i), 1.2 * std::cos(2.0 * i));
    CommonTerm term;
    term.lever = lever_at(error, at, velocity);
    term.off = term.lever * truth;
    term.noise = 0.05 * 0.05 * Eigen::Matrix2d::Identity();
    error = updated(error, term);
  }
  EXPECT_NEAR(error.mean.x(), truth.x(), 0.03);
  EXPECT_NEAR(error.mean.y(), truth.y(), 0.03);
  EXPECT_NEAR(error.mean[2], truth[2], deg(0.5));
  EXPECT_NEAR(error.mean[3], truth[3], 0.02);
  EXPECT_LT(error.covariance(0, 0), 0.1 * before.covariance(0, 0));
}

TEST(CommonErrors, HaveTheLeverOfATurnedCell) {
  CommonError error;
  error.pivot = {1.0, 2.0};
  const double yaw = 1e-3;
  const Eigen::Vector3d x(3.0, 0.0, 5.0);
  const Eigen::Vector3d pivot(1.0, 0.0, 2.0);
  const Eigen::Vector3d turned = about_y(yaw) * (x - pivot) + pivot;
  const Eigen::Vector2d by = lever_at(error, {3.0, 5.0}, {0, 0}) * Eigen::Vector4d(0, 0, yaw, 0);
  EXPECT_NEAR(by.x(), turned.x() - x.x(), 1e-5);
  EXPECT_NEAR(by.y(), turned.z() - x.z(), 1e-5);
}

TEST(CommonErrors, OfFarCellsGrowWithTheirTurn) {
  const CommonError near = stated_error(place_at(0, 0, 0.1), place_at(2, 0, 0.1), {});
  const CommonError far = stated_error(place_at(0, 0, 0.1), place_at(40, 0, 0.1), {});
  EXPECT_GT(far.covariance(1, 1), 2.0 * near.covariance(1, 1));
}

TEST(CommonErrors, AreAssumedWhereNothingIsStated) {
  CellPlace nothing;
  const SiteConfig config;
  const CommonError error = stated_error(nothing, nothing, config);
  EXPECT_GE(error.covariance(0, 0), 2 * config.unknown_place_sigma * config.unknown_place_sigma);
}

}  // namespace
}  // namespace chorus::site

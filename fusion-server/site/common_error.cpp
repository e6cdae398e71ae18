#include "fusion-server/site/common_error.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/base/square.h"

namespace chorus::site {
namespace {

// What a second adds to the standard deviations: [m], [rad], [s].
constexpr double kPlaceDrift = mm(2);
constexpr double kYawDrift = deg(0.02);
constexpr double kClockDrift = 0.5e-3;

/// Covariance of (displacement x, displacement z, yaw) at the pivot, from one cell's place.
Eigen::Matrix3d at_pivot(const CellPlace& place, const Eigen::Vector2d& pivot,
                         const SiteConfig& config) {
  Eigen::Matrix3d known = Eigen::Matrix3d::Zero();
  if (place.covariance.isZero()) {
    known(0, 0) = known(1, 1) = square(config.unknown_place_sigma);
    known(2, 2) = square(config.unknown_yaw_sigma);
    return known;
  }
  const Eigen::Vector3d origin = place.site_from_cell.translation();
  const Eigen::Vector2d arm(pivot.x() - origin.x(), pivot.y() - origin.z());
  Eigen::Matrix<double, 3, 6> to_pivot = Eigen::Matrix<double, 3, 6>::Zero();
  to_pivot(0, 1) = arm.y();
  to_pivot(1, 1) = -arm.x();
  to_pivot(0, 3) = to_pivot(1, 5) = to_pivot(2, 1) = 1.0;
  known = to_pivot * place.covariance * to_pivot.transpose();
  return known;
}

double clock_variance(const CellPlace& place, const SiteConfig& config) {
  return square(
      seconds(place.clock_sigma > Duration{0} ? place.clock_sigma : config.unknown_clock_sigma));
}

struct Innovation {
  Eigen::Vector2d off;
  Eigen::Matrix2d covariance;
};

Innovation innovation_of(const CommonError& error, const CommonTerm& term) {
  return {term.off - term.lever * error.mean,
          term.lever * error.covariance * term.lever.transpose() + term.noise};
}

}  // namespace

Eigen::Matrix3d covariance_at(const CellPlace& place, const Eigen::Vector3d& x,
                              const SiteConfig& config) {
  Eigen::Matrix<double, 6, 6> known = place.covariance;
  if (known.isZero()) {
    // On the floor, as at_pivot(): it is level, and its height is that of the floor.
    known(1, 1) = square(config.unknown_yaw_sigma);
    known(3, 3) = known(5, 5) = square(config.unknown_place_sigma);
  }
  const Eigen::Vector3d arm = x - place.site_from_cell.translation();
  Eigen::Matrix<double, 3, 6> to_x = Eigen::Matrix<double, 3, 6>::Zero();
  to_x.leftCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  to_x.rightCols<3>().setIdentity();
  return to_x * known * to_x.transpose();
}

CommonError stated_error(const CellPlace& ours, const CellPlace& theirs, const SiteConfig& config) {
  CommonError error;
  const Eigen::Vector3d middle =
      0.5 * (ours.site_from_cell.translation() + theirs.site_from_cell.translation());
  error.pivot = {middle.x(), middle.z()};
  error.covariance.topLeftCorner<3, 3>() =
      at_pivot(ours, error.pivot, config) + at_pivot(theirs, error.pivot, config);
  error.covariance(3, 3) = clock_variance(ours, config) + clock_variance(theirs, config);
  const Eigen::Vector4d least(config.place_sigma, config.place_sigma, config.yaw_sigma,
                              seconds(config.clock_sigma));
  error.covariance.diagonal() += least.cwiseAbs2();
  return error;
}

Eigen::Matrix<double, 2, 4> lever_at(const CommonError& error, const Eigen::Vector2d& x,
                                     const Eigen::Vector2d& velocity) {
  const Eigen::Vector2d arm = x - error.pivot;
  Eigen::Matrix<double, 2, 4> lever;
  lever << 1.0, 0.0, arm.y(), velocity.x(), 0.0, 1.0, -arm.x(), velocity.y();
  return lever;
}

double log_density(const CommonError& error, const CommonTerm& term) {
  const Innovation found = innovation_of(error, term);
  const double determinant = std::max(1e-12, found.covariance.determinant());
  const double distance = found.off.dot(found.covariance.inverse() * found.off);
  return -0.5 * distance - 0.5 * std::log(determinant) - std::log(2.0 * std::numbers::pi);
}

CommonError updated(const CommonError& error, const CommonTerm& term) {
  const Innovation found = innovation_of(error, term);
  const Eigen::Matrix<double, 4, 2> gain =
      error.covariance * term.lever.transpose() * found.covariance.inverse();
  CommonError next = error;
  next.mean += gain * found.off;
  const Eigen::Matrix4d rest = Eigen::Matrix4d::Identity() - gain * term.lever;
  // Joseph's form: stays positive.
  next.covariance =
      rest * error.covariance * rest.transpose() + gain * term.noise * gain.transpose();
  return next;
}

void drift(CommonError& error, double elapsed) {
  const Eigen::Vector4d each(kPlaceDrift, kPlaceDrift, kYawDrift, kClockDrift);
  error.covariance.diagonal() += std::max(0.0, elapsed) * each.cwiseAbs2();
}

}  // namespace chorus::site

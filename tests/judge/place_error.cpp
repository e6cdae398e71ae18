#include "tests/judge/place_error.h"

#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::bench {

PlaceError place_error(const Eigen::Isometry3d& estimated, const Eigen::Isometry3d& exact,
                       const Eigen::Vector3d& up) {
  const Eigen::Matrix3d turn = estimated.linear() * exact.linear().transpose();
  const Eigen::Vector3d omega = log_map(Eigen::Quaterniond(turn));
  const double yaw = omega.dot(up);
  const Eigen::Vector3d off = estimated.translation() - exact.translation();
  const double height = off.dot(up);
  return {off.norm(), (off - height * up).norm(), std::abs(height), std::abs(yaw),
          (omega - yaw * up).norm()};
}

double point_error(const Eigen::Isometry3d& estimated, const Eigen::Isometry3d& exact,
                   const Eigen::Vector3d& x_in_target) {
  return (estimated * (exact.inverse() * x_in_target) - x_in_target).norm();
}

}  // namespace chorus::bench

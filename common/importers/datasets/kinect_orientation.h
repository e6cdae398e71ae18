// Kinect v2 joint orientations as files store them: w x y z, all zero at the leaf joints.
#pragma once

#include <array>

#include <Eigen/Geometry>

namespace chorus::importers {

/// The parts of a unit quaternion are within +-1; with a part beyond this bound, four numbers are
/// not a quaternion.
inline constexpr double kMaxQuaternionPart = 1.01;

/// Normalised if the norm is within 1 % of one; otherwise all zero, which means "not given".
[[nodiscard]] inline Eigen::Quaterniond orientation_wxyz(const std::array<double, 4>& wxyz) {
  // Files keep six digits; a larger deviation is not due to rounding.
  constexpr double kNormSlack = 0.01;
  const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double norm = q.norm();
  if (!(norm > 1.0 - kNormSlack && norm < 1.0 + kNormSlack)) return {0, 0, 0, 0};
  return q.normalized();
}

}  // namespace chorus::importers

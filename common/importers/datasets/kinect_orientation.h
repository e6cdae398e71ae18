// Kinect v2 joint orientations as files hold them: w x y z, all zero at the leaves.
#pragma once

#include <array>

#include <Eigen/Geometry>

namespace chorus::importers {

/// A part of a unit quaternion is within +-1; more than this is not a quaternion at all.
inline constexpr double kMaxQuaternionPart = 1.01;

/// Normalised where the norm is within 1 % of one, else all zero: "not given".
[[nodiscard]] inline Eigen::Quaterniond orientation_wxyz(const std::array<double, 4>& wxyz) {
  constexpr double kNormSlack = 0.01;  // files keep six digits; more is no rounding
  const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double norm = q.norm();
  if (!(norm > 1.0 - kNormSlack && norm < 1.0 + kNormSlack)) return {0, 0, 0, 0};
  return q.normalized();
}

}  // namespace chorus::importers

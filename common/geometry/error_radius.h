// The 95 % radius of a place's error.
#pragma once

#include <Eigen/Core>

namespace chorus {

/// Radius of the circle about the mean that holds 95 % of a normal distribution on the plane [m]:
/// 2.45 sigma for a round one, 1.96 sigma of the long axis for a narrow one.  Infinite if the
/// matrix is not a covariance.
[[nodiscard]] double radius_of_95(const Eigen::Matrix2d& covariance);

/// radius_of_95() of the position on the floor (x, z), from a covariance of (rotation vector,
/// position) in world axes.
[[nodiscard]] double radius_on_floor(const Eigen::Matrix<double, 6, 6>& covariance);

}  // namespace chorus

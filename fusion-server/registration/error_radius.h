// How far off a place is at most, with 95 % probability.
#pragma once

#include <Eigen/Core>

namespace chorus::registration {

/// Radius of the circle about the mean that holds 95 % of a normal distribution on the plane [m]:
/// 2.45 sigma for a round one, 1.96 sigma of the long axis for a narrow one.
/// Infinite for what is no covariance.
[[nodiscard]] double radius_of_95(const Eigen::Matrix2d& covariance);

/// The same for the place on the floor, x and z, of a covariance of (turn, place) in world axes.
[[nodiscard]] double radius_on_floor(const Eigen::Matrix<double, 6, 6>& covariance);

}  // namespace chorus::registration

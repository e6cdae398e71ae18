// Transforms covariances of a motion (omega, tau) into other frames (docs/papers/registration.md,
// Section 1).
#pragma once

#include <Eigen/Geometry>

namespace chorus::registration {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Ad: Exp(Ad xi) b_from_a = b_from_a Exp(xi), for xi = (omega, tau).
[[nodiscard]] Matrix6 adjoint(const Eigen::Isometry3d& b_from_a);

/// From (omega, tau) to (omega, displacement of the point x): tau + omega x x.
[[nodiscard]] Matrix6 at_point(const Eigen::Vector3d& x);

}  // namespace chorus::registration

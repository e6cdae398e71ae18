// The part of two sensors' error that no length of walk reveals: a body's joints appear at other
// positions when it is seen from elsewhere (docs/papers/registration.md, Section 8).
#pragma once

#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {

/// Covariance of (omega, tau) between two sensors, in world axes about the world's origin: 4 mm and
/// 0.07 deg of yaw for each, at the middle of the walk.
[[nodiscard]] Matrix6 view_bias(const Eigen::Vector3d& middle_in_world);

}  // namespace chorus::registration

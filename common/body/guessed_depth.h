// Joints whose depth a camera guessed from the size of the person.
#pragma once

#include <Eigen/Core>

#include "common/body/skeleton.h"

namespace chorus {

/// True if the joint states an error along the line of sight from `eye` of at least 4 % of its
/// distance and three times the error across.  `eye`: the sensor's position, in the joint's space.
[[nodiscard]] bool has_guessed_depth(const Joint& joint, const Eigen::Vector3d& eye);

}  // namespace chorus

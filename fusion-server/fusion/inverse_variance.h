// Robust inverse-variance fusion of one joint.
//
// Sigma_i is what the error model says of each sighting (error_model.h):
//   p = argmin sum_i rho(|p_i - p|_Sigma_i),             rho = Huber, solved by re-weighting
// Two sensors at right angles thus replace each other's depth.  Convex: the start does not matter.
#pragma once

#include <span>

#include "fusion-server/fusion/sighting.h"

namespace chorus::fusion {

/// `huber` in standard deviations.
[[nodiscard]] FusedJoint inverse_variance(std::span<const Sighting> sightings, double huber);

}  // namespace chorus::fusion

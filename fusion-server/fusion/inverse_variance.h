// Robust inverse-variance fusion of one joint.
//
// Sigma_i is the covariance that the error model gives to each view (error_model.h):
//   p = argmin sum_i rho(|p_i - p|_Sigma_i),             rho = Huber, solved by re-weighting
// The stated covariance is the inverse of the views' summed information, computed with their pose
// errors (pose_error.h) added; pose errors do not affect p.  Two sensors at right angles thus
// correct each other's depth.  Convex: the start does not matter.
#pragma once

#include <span>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {

/// `huber` is in standard deviations.
[[nodiscard]] FusedJoint inverse_variance(std::span<const JointView> views, double huber);

}  // namespace chorus::fusion

// Robust inverse-variance fusion of one joint.
//
// Sigma_i is the covariance that the error model gives to each view (error_model.h):
//   p = argmin sum_i rho(|p_i - p|_Sigma_i),             rho = Huber, solved by re-weighting
// The covariance stated is the inverse of the information of the views with their pose errors
// (pose_error.h) added; these have no part in p.
// Two sensors at right angles thus correct each other's depth.  Convex: the start does not matter.
#pragma once

#include <span>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {

/// `huber` in standard deviations.
[[nodiscard]] FusedJoint inverse_variance(std::span<const JointView> views, double huber);

}  // namespace chorus::fusion

// Errors that were learned from recordings, as the error model of fusion.
//
// A predictor says how far a joint is from the true one, e [m].  Its covariance has the shape of
// the line-of-sight model and the size of the prediction:
//   Sigma = S (rms e)^2 / trace(S),   S: line_of_sight_covariance(), rms: JointPredictor::rms
// The predicted error is the joint's whole error, the pose error included, so no other is added.
#pragma once

#include "fusion-server/fusion/error_model.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

/// The errors as configured: a sensor's learned ones where it or all sensors have a predictor, else
/// line_of_sight_errors().  Rays, joints with a covariance of their own, and joints that the
/// predictor does not know keep the latter.
[[nodiscard]] std::unique_ptr<const ErrorModel> errors_of(const FusionConfig& config);

}  // namespace chorus::fusion

// One body over time: a person is not a set of separate joints but a body that keeps the lengths of
// its bones and moves smoothly (docs/papers/body.md).
//
// At each instant all views are combined (sighted_body.h), the bones hold the joints together at
// the lengths learned so far (bone_lengths.h), and each joint is filtered (motion_filter.h).  A
// joint that no sensor sees is predicted for BodyModel::carry and moves with its bones; it is then
// Inferred and has no contributors.  The stated covariance is that of the position at the instant;
// it includes the views' slow errors, the error common to all sensors, and the filter's own error.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> body_filter(const FusionConfig& config);

}  // namespace chorus::fusion

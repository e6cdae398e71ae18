// One body over time: what is known of a person is not a joint here and there but a body, which
// keeps the lengths of its bones and moves smoothly (docs/papers/body.md).
//
// At each instant all views are put together (sighted_body.h), the bones hold the joints together
// at the lengths learned so far (bone_lengths.h), and each joint is filtered (motion_filter.h).  A
// joint that nobody sees is carried for BodyModel::carry, drawn along by its bones; it is then
// Inferred and nobody contributes to it.  The stated covariance is that of the place at the
// instant: slow errors of the views, what all sensors share, and the filter's own.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> body_filter(const FusionConfig& config);

}  // namespace chorus::fusion

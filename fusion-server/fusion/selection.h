// The methods that trust one view at a time, as Otto et al. 2.4 list them.
//
// - best-skeleton: the whole view with the highest score (view_score.h).  It changes only when
//   another view has been better for FusionConfig::hysteresis, or when it is gone, so that the body
//   does not flicker between two equal views.
// - joint-counting: the whole view with the most tracked joints.
// - substitution: the best skeleton, but a joint that it does not track comes from the best view
//   that tracks it.
//
// Of equal views, the one with the smallest sensor id is taken.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> best_skeleton(const FusionConfig& config);
[[nodiscard]] std::unique_ptr<Estimator> joint_counting(const FusionConfig& config);
[[nodiscard]] std::unique_ptr<Estimator> substitution(const FusionConfig& config);

}  // namespace chorus::fusion

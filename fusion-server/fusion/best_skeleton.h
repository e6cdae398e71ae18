// One view alone, where Otto et al. 5.2.5 begin: the best skeleton.  The view changes only after
// another has been better for FusionConfig::hysteresis, or when it is gone, so that the body does
// not flicker between two equal views.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> best_skeleton(const FusionConfig& config);

}  // namespace chorus::fusion

// One view alone, as Otto et al. 5.2.5 begin: the best skeleton.  It changes hands only after
// another view has been better for FusionConfig::hysteresis, or when its own is gone, so that two
// equal views do not make the body flicker between them.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> best_skeleton(const FusionConfig& config);

}  // namespace chorus::fusion

// The best skeleton (Otto et al. 5.2.5): one view at a time is used unchanged.  The view is
// switched only after another has been better for FusionConfig::hysteresis, or when it is gone, so
// that the body does not flicker between two equally good views.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> best_skeleton(const FusionConfig& config);

}  // namespace chorus::fusion

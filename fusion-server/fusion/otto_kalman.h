// A Kalman filter per joint with Otto's weights in R: R = sigma^2 / (w + 0.02), w of Eqs. (1)-(3).
//
// Otto et al. 5.2.5 name the Kalman filter as the next step after the weighted mean and leave its
// design open.  A joint that no sensor sees is predicted for FusionConfig::kalman_coast; during
// that time it is Inferred and has no contributors.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> otto_kalman(const FusionConfig& config);

}  // namespace chorus::fusion

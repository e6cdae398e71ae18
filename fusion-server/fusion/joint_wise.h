// Methods without memory that fuse each joint separately: Otto's weighted mean, the plain mean, the
// view of the highest weight, robust inverse variance (Otto et al. 5.2.5; inverse_variance.h).
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> joint_wise(const FusionConfig& config);

}  // namespace chorus::fusion

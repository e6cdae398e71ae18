// Each joint by robust least squares over all its measurements: points, and the rays of cameras
// without depth (least_squares.h).
//
// Two or more rays usually determine a point. A single ray does not: the joint is missing, unless
// its last position limits its depth. That position is predicted from the last instants in which
// the joint was determined (point_filter.h), with a growing variance, for at most
// config.kalman_coast; a joint found in this way is Inferred. Rays that leave an axis more
// uncertain than config.max_sigma determine no point either.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> points_and_rays(const FusionConfig& config);

}  // namespace chorus::fusion

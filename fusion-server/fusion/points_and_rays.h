// Each joint by robust least squares over everything that is known of it: points, and the rays of
// cameras without depth (least_squares.h).
//
// Two rays or more make a point.  A single ray makes none: the joint is missing, unless the place
// it had bounds its depth.  That place is predicted from the last instants in which the joint was
// determined (point_filter.h), with a variance that grows, for at most config.kalman_coast; a joint
// so bounded is Inferred.  Rays that leave an axis more uncertain than config.max_sigma make no
// point either.
#pragma once

#include <memory>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

[[nodiscard]] std::unique_ptr<Estimator> points_and_rays(const FusionConfig& config);

}  // namespace chorus::fusion

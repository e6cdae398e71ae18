// A fused body as it is expected to be a moment later.
//
// Each joint moves on as its filter expects (later() in motion_filter.h), and the bones keep the
// lengths that they have.
#pragma once

#include "common/base/duration.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::fusion {

/// The body `ahead` later; the body itself if `ahead` is not positive.  Without FusedBody::motion,
/// nothing is known of velocities: the pose stays as it is, and its covariance grows as if the
/// standard deviation of each velocity were kFirstSpeed.
[[nodiscard]] FusedBody predicted(const FusedBody& body, Duration ahead);

}  // namespace chorus::fusion

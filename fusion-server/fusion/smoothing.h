// A fused body as later instants show it: the backward half of each joint's filter (Rauch, Tung and
// Striebel).
//
// With x, P the filter's position and velocity and their covariance after an instant, F and Q the
// step to the next (docs/papers/body.md (20)):
//   P' = F P F^T + Q,   G = P F^T P'^-1,
//   x_s = x + G (x_s,next - F x),   P_s = P + G (P_s,next - P') G^T
// A joint that nobody sees for a while is thereby placed between where it was and where it turns
// up.  Only what the filter added can be taken off the stated covariance: the views' slow errors
// stay.
#pragma once

#include <span>

#include "common/time/timestamp.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::fusion {

struct BodyAt {
  Timestamp instant;
  const FusedBody* body = nullptr;  ///< Never null.
};

/// The first of the bodies, which are one person's in order of time.  Unchanged if it is alone or
/// has no FusedBody::motion.
[[nodiscard]] FusedBody smoothed(std::span<const BodyAt> bodies);

}  // namespace chorus::fusion

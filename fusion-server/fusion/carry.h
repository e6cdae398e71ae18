// A body that no sensor sees any more, placed where the person is expected.
#pragma once

#include "common/base/duration.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::fusion {

/// The last body, moved on the floor so that its middle is at `middle` (world [m]).  `unseen`: time
/// since a sensor last saw the person.  The joints are inferred, nobody contributes to them, and
/// their covariance grows with that time.
[[nodiscard]] FusedBody carry(const FusedBody& last, Duration unseen,
                              const Eigen::Vector3d& middle);

}  // namespace chorus::fusion

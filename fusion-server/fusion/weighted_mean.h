// Otto 5.2.5: "joint-wise, weighted mean for the position and the orientation ... using the LERP
// algorithm".
#pragma once

#include <span>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {

/// Positions by sum w p / sum w, orientation by sign-aligned LERP. Views with zero weight
/// contribute nothing; when every weight is zero there is no result (what happens then is up to the
/// caller, see decision 0007).
[[nodiscard]] FusedJoint weighted_mean(std::span<const JointView> views);

}  // namespace chorus::fusion

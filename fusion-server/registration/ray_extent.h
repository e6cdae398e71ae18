// How large a rig of rays is, and whether the walk that it was solved from was wide enough.
#pragma once

#include <vector>

#include "common/base/result.h"
#include "fusion-server/registration/ray_points.h"

namespace chorus::registration {

/// What to multiply the rig by so that the person who walks is 1.70 m tall: from shanks, thighs and
/// trunk, or from the trunk alone where legs are not seen (Drillis and Contini 1966).  Unavailable
/// if neither was seen.
[[nodiscard]] Result<double> metres_per_unit(const std::vector<RayPoint>& points);

/// Unavailable, with what to do, if the person stayed on the spot or walked along one line.
/// `points`: in metres.
[[nodiscard]] Result<void> wide_enough(const std::vector<RayPoint>& points);

}  // namespace chorus::registration

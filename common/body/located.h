// Located: the positions of a body's joints, without states and orientations.
#pragma once

#include <array>
#include <optional>

#include "common/body/skeleton.h"

namespace chorus {

/// Positions of a person's joints [m], where known; in world space.
using Located = std::array<std::optional<Eigen::Vector3d>, kJointCount>;

/// The positions of the joints that are seen as points.
[[nodiscard]] Located points_of(const Skeleton<WorldSpace>& body);

/// Mean of the core joints, or of all joints if no core joint is located; nothing if none is.
[[nodiscard]] std::optional<Eigen::Vector3d> middle_of(const Located& body);

}  // namespace chorus

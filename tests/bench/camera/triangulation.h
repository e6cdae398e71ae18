// What careful offline work makes of the landmarks of calibrated cameras: the baseline of the cases
// with real cameras.  It knows where the cameras are and which landmark is which, looks at one
// instant at a time, and shares no code with fusion.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace chorus::bench {

/// A ray in world space.
struct SeenAlong {
  Eigen::Vector3d eye;
  Eigen::Vector3d direction;  ///< Unit length.
};

/// The point that most rays pass: of all pairs of rays the point with the most others within 1.5
/// deg, then least squares of angles with Cauchy's weights (0.5 deg).  None for less than two rays,
/// or if no two of them meet in front of their cameras.
[[nodiscard]] std::optional<Eigen::Vector3d> triangulated(const std::vector<SeenAlong>& rays);

}  // namespace chorus::bench

// The origin of the world from marks on the floor: where each is now, and where it shall be.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/alignment/floor_pose.h"
#include "common/base/result.h"

namespace chorus::alignment {

/// Marks that are nearer to one another than this do not tell a direction [m].
inline constexpr double kLeastApart = 0.5;
/// A mark that is farther than this from where the others put it refuses the fit [m].
inline constexpr double kMostOff = 0.10;

/// Places on the floor are (x, z) [m].
struct FloorMark {
  Eigen::Vector2d now;    ///< In the world as it is.
  Eigen::Vector2d shall;  ///< In the world to be.
};

struct MarkedOrigin {
  FloorPose origin;         ///< As `chorus origin --x --z --yaw` takes it.
  std::vector<double> off;  ///< By mark: how far it will be from where it shall be [m].
  double apart = 0.0;       ///< Between the two marks that are farthest from each other [m].
};

/// Least squares over yaw and place.  InvalidArgument: fewer than two marks, or all within
/// kLeastApart.  Conflict: a mark is off by more than kMostOff; the error says whether left and
/// right are exchanged.
[[nodiscard]] Result<MarkedOrigin> origin_from_marks(std::span<const FloorMark> marks);

/// From where the origin is, from any place straight ahead of it, and from one on the left of that
/// line (+x).  The third only checks: Conflict if it is on the right, or within 0.1 m of the line.
/// InvalidArgument: two of them are within kLeastApart.
[[nodiscard]] Result<MarkedOrigin> origin_from_axes(const Eigen::Vector2d& origin,
                                                    const Eigen::Vector2d& ahead,
                                                    const std::optional<Eigen::Vector2d>& left);

/// "0.5,-2" -> (0.5, -2); within 1000 m.
[[nodiscard]] Result<Eigen::Vector2d> read_place(std::string_view text);
/// "0.1,2.3=0,0": where it is, and where it shall be.
[[nodiscard]] Result<FloorMark> read_mark(std::string_view text);

}  // namespace chorus::alignment

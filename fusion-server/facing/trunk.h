// How a person's trunk is tilted.  What was learned from upright people, and what is defined by
// the vertical, says nothing about people who lie or are upside down (docs/papers/sides.md,
// Upright).
#pragma once

#include <vector>

#include "common/base/units.h"
#include "fusion-server/flow/person.h"

namespace chorus::facing {

struct UprightRange {
  double full = deg(45);  ///< Tilt of the trunk from the vertical up to which people are upright.
  double none = deg(75);  ///< Tilt from which they are not upright at all.

  bool operator==(const UprightRange&) const = default;
};

/// Unit vector from the lower to the upper end of the spine, the mean of the views, in world space;
/// straight up if no view shows it.
[[nodiscard]] Eigen::Vector3d trunk_of(const std::vector<SensorView>& views);

/// How far somebody with this trunk is upright, in [0, 1]; between the two tilts it falls in
/// proportion to the cosine of the tilt.
[[nodiscard]] double upright_share(const Eigen::Vector3d& trunk, const UprightRange& range);

}  // namespace chorus::facing

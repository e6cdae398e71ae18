// How a body stands relative to the sensor that sees it (Otto 5.2.2; inputs of Eqs. (1)-(3)).
//
// common/body/facing.h computes the angles.  Here an unknown angle becomes NaN, for which every
// quality heuristic gives weight zero.
#pragma once

#include <limits>

#include "common/body/body_frame.h"

namespace chorus::facing {

/// Radians and metres in the observing sensor's space; NaN: unknown.
struct Aspect {
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< Sensor to neck; d of Eq. (1).
  double facing = std::numeric_limits<double>::quiet_NaN();    ///< phi of Eq. (2).
  double bearing = std::numeric_limits<double>::quiet_NaN();   ///< alpha of Eq. (3), of the neck.
  /// Of the joints on the body's centre axis, the bearing that is farthest off the optical axis.
  double axis_bearing = std::numeric_limits<double>::quiet_NaN();
};

[[nodiscard]] Aspect aspect_of(const BodyFrame& body);

}  // namespace chorus::facing

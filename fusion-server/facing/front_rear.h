// How a body stands before the sensor that sees it (Otto 5.2.2 and the inputs of Eqs. (1)-(3)).
//
// Thin: the angles are common/body/facing.h; this stage turns "cannot tell" into NaN, which every
// quality heuristic answers with weight zero.
#pragma once

#include <limits>

#include "common/body/body_frame.h"

namespace chorus::facing {

/// Radians and metres in the observing sensor's space; NaN: unknown.
struct Sight {
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< Sensor to neck; d of Eq. (1).
  double facing = std::numeric_limits<double>::quiet_NaN();    ///< phi of Eq. (2).
  double bearing = std::numeric_limits<double>::quiet_NaN();   ///< alpha of Eq. (3).
};

[[nodiscard]] Sight view_of(const BodyFrame& body);

/// The sensor looks at the back: |phi| > 90 deg.  An unknown facing is not a rear view.
[[nodiscard]] bool from_behind(const Sight& sight) noexcept;

}  // namespace chorus::facing

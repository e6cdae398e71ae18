// How uncertain one sensor is of a joint: of a place along and across its line of sight, or of a
// direction.
#pragma once

#include "common/base/units.h"

namespace chorus::fusion {

/// Standard deviations [m].  Defaults: a Kinect-like depth sensor at 2.5 m, of which slow errors
/// alike in all directions are the largest part; a camera whose landmarks are good to 26 mm at 3 m.
struct NoiseModel {
  double along = 0.015;
  double across = 0.015;
  double inferred_factor = 2.0;  ///< Inferred joints are this much worse.
  double ray = deg(0.5);         ///< Of a ray without a covariance of its own [rad].

  bool operator==(const NoiseModel&) const = default;
};

}  // namespace chorus::fusion

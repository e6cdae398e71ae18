// How uncertain one sensor's measurement of a joint is: of a position along and across the line of
// sight, or of a direction.
#pragma once

#include "common/base/units.h"

namespace chorus::fusion {

/// Standard deviations [m].  Defaults: a Kinect-like depth sensor at 2.5 m, with mostly slow errors
/// that are equal in all directions; a camera whose landmarks are accurate to 26 mm at 3 m.
struct NoiseModel {
  double along = 0.015;
  double across = 0.015;
  double inferred_factor = 3.0;  ///< Factor on the standard deviations of inferred joints.
  double ray = deg(0.5);         ///< Direction of a ray that states no covariance [rad].

  bool operator==(const NoiseModel&) const = default;
};

}  // namespace chorus::fusion

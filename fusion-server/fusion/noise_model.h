// How uncertain one sensor's joint position is, along and across its line of sight.
#pragma once

namespace chorus::fusion {

/// Standard deviations [m].  Defaults: a Kinect-like depth sensor at 2.5 m, whose depth is the
/// weaker axis.
struct NoiseModel {
  double along = 0.030;
  double across = 0.015;
  double inferred_factor = 3.0;  ///< Inferred joints are this much worse.

  bool operator==(const NoiseModel&) const = default;
};

}  // namespace chorus::fusion

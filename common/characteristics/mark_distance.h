// By how much a sensor reports a person too near, from a tape: the person stands on a mark on the
// floor whose horizontal distance from the sensor was measured, and turns there once.
//
// A joint of the spine is off the mark by some centimetres, but that offset turns with the person:
// with theta the angle of the front away from the sensor, the joint's horizontal distance is
//
//   r(theta) = D - b + p cos(theta) + q sin(theta)
//
// fitted by least squares over sectors of theta, so that nobody has to stand exactly on the mark.
// What is left of a sector is how the error differs from view to view.
#pragma once

#include <optional>

#include "common/characteristics/turning.h"

namespace chorus::characteristics {

/// Horizontal distance on the floor from below the sensor to the mark, and how well it was measured
/// (1 sigma) [m].
struct Mark {
  double distance = 0.0;
  double sigma = 0.01;
};

/// How much nearer than they are joints are reported, along the line of sight [m].
struct DepthBias {
  double bias = 0.0;
  /// Of the mean over joints and sides: of the tape, and by how much joints, and the front, the
  /// side and the rear of a person, differ (1 sigma).
  double sigma = 0.0;
  double front = 0.0, side = 0.0, rear = 0.0;  ///< By where the person's front is.
};

/// InvalidArgument, saying what to do, without a floor plane (the sensor may be tilted), or if the
/// person did not turn by most of a circle.
[[nodiscard]] Result<DepthBias> depth_bias_by(const Mark& mark, const OnePerson& person,
                                              const std::vector<Stance>& stances);

}  // namespace chorus::characteristics

// By how much a sensor reports a person too near, from a tape: the person stands on a mark on the
// floor whose horizontal distance from the sensor was measured, and turns there once.
//
// A joint of the spine is some centimetres beside the mark, but this offset turns with the person.
// If theta is the angle of the person's front away from the sensor, the joint's horizontal distance
// is
//
//   r(theta) = D - b + p cos(theta) + q sin(theta)
//
// fitted by least squares over sectors of theta, so that nobody has to stand exactly on the mark.
// The sectors' own means, without p and q, show how the bias differs from front to side and rear.
#pragma once

#include <optional>

#include "common/characteristics/turning.h"

namespace chorus::characteristics {

/// Distance along the floor from the point below the sensor to the mark, and its standard deviation
/// [m].
struct Mark {
  double distance = 0.0;
  double sigma = 0.01;
};

/// By how much joints are reported too near, along the line of sight [m].
struct MeasuredDepthBias {
  double bias = 0.0;
  double sigma = 0.0;  ///< Standard deviation of `bias`.
};

struct MarkedDepthBias {
  /// The sigma is from the tape, and from how far the joints, and the front, the side and the rear
  /// of the person, differ.
  MeasuredDepthBias mean;
  double front = 0.0, side = 0.0, rear = 0.0;  ///< The bias by where the person's front is [m].
};

/// InvalidArgument, saying what to do, if there is no floor plane (the sensor may be tilted), or if
/// the person did not turn through most of a circle.
[[nodiscard]] Result<MarkedDepthBias> depth_bias_by(const Mark& mark, const OnePerson& person,
                                                    const std::vector<Stance>& stances);

}  // namespace chorus::characteristics

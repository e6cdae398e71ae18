// What sensors of one kind have in common: turns the characteristics of one or several of them into
// settings of fusion, registration and simulation.
#pragma once

#include <optional>
#include <vector>

#include "common/characteristics/agreement.h"
#include "common/characteristics/characteristics.h"

namespace chorus::characteristics {

/// All that was measured.
struct Measured {
  std::vector<Characteristics> sensors;
  std::optional<Agreement> agreement;            ///< Of registered sensors.
  std::optional<MeasuredDepthBias> walked_bias;  ///< What their walk says.
};

struct Kind {
  FrontRear front_rear = FrontRear::Unknown;
  std::optional<double> exchanged_at, back_at;  ///< Medians [rad].
  Noise jitter;       ///< Of the trunk; root mean square over the sensors.
  Noise limb_jitter;  ///< The same of elbows, wrists, knees and ankles.
  Delivery delivery;  ///< Means over the sensors; the longest gap of any.
  /// What fusion.noise should be; none if the recordings do not tell.  It contains errors that
  /// last, which jitter does not show.  So it is known from several registered sensors, or, as a
  /// lower limit, from a jitter that alone exceeds `usual`.
  std::optional<Noise> noise;
  /// The depth bias to tell registration, measured with a mark or, if there was none, by a walk.
  /// None if it is below two of its standard deviations: to correct a bias that does not exist
  /// costs accuracy.
  std::optional<MeasuredDepthBias> depth_bias;
};

/// `usual`: the noise that fusion assumes of a sensor about which nothing is known [m].
[[nodiscard]] Kind kind_of(const Measured& measured, double usual);

}  // namespace chorus::characteristics

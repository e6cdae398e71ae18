// What sensors of one kind have in common: from the characteristics of one or several of them to
// what fusion, registration and simulation can be told.
#pragma once

#include <optional>
#include <vector>

#include "common/characteristics/agreement.h"
#include "common/characteristics/characteristics.h"

namespace chorus::characteristics {

/// All that was measured.
struct Measured {
  std::vector<Characteristics> sensors;
  std::optional<Agreement> agreement;    ///< Of registered sensors.
  std::optional<DepthBias> walked_bias;  ///< What their walk says; only bias and sigma are set.
};

struct Kind {
  FrontRear front_rear = FrontRear::Unknown;
  std::optional<double> exchanged_at, back_at;  ///< Medians [rad].
  Noise jitter;       ///< Of the trunk; root mean square over the sensors.
  Noise limb_jitter;  ///< The same of elbows, wrists, knees and ankles.
  Delivery delivery;  ///< Means over the sensors.
  /// What fusion.noise should be, if the recordings say so: errors that last are in it, so it needs
  /// several registered sensors, or a jitter that is larger than `usual` all by itself.
  std::optional<Noise> noise;
  /// The depth bias to tell registration: measured by a mark or by a walk, and at least two of its
  /// own standard deviations, because a bias that is not there costs accuracy.
  std::optional<DepthBias> depth_bias;
};

/// `usual`: what fusion takes of a sensor that nothing is known of [m].
[[nodiscard]] Kind kind_of(const Measured& measured, double usual);

}  // namespace chorus::characteristics

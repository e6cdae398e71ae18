// Parameters of what the server learns of inertial sensors that people wear.
#pragma once

#include "common/base/duration.h"
#include "common/base/units.h"

namespace chorus::worn {

struct WornConfig {
  /// Whether sensors are calibrated and handed to fusion at all.
  bool enabled = false;
  /// How far a heading may wander in a second, as the standard deviation of a random walk
  /// [rad / sqrt(s)]: beside limbs that real cameras see this forgets over 5 to 10 s.
  double heading_walk = deg(1.0);
  /// A lasting turn of a sensor on its limb is a slip if it exceeds this by three times what that
  /// limb usually shows [rad].
  double slip = deg(10);
  /// A calibration that would know its limb's direction worse than this in the poses it was made in
  /// is refused [rad].
  double most_prediction = deg(10);
  /// A sensor whose own stated error exceeds this is told, because fusion lets it have no say
  /// (InertialModel::most_sigma, the same key) [rad].
  double most_sigma = deg(30);

  bool operator==(const WornConfig&) const = default;
};

}  // namespace chorus::worn

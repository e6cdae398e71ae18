// Parameters of how worn inertial sensors steer a fused body (inertial_limbs.h).
#pragma once

#include "common/base/duration.h"
#include "common/base/units.h"

namespace chorus::fusion {

struct InertialModel {
  bool enabled = false;
  /// Views and sensor that differ by more than this disagree [standard deviations of their
  /// difference]: the sensor then counts less and less, and the joint's stated error grows.
  double gate = 2.5;
  /// While a limb is hidden, what it was last seen to differ from its sensor fades in this time:
  /// skin and calibration err alike for about a second.
  Duration hidden = std::chrono::seconds(1);
  /// A joint that is seen again is handed back to the views in this time.
  Duration handback = std::chrono::milliseconds(200);
  /// A sensor that knows its limb's direction worse than this has no say [rad].
  double most_sigma = deg(30);

  bool operator==(const InertialModel&) const = default;
};

}  // namespace chorus::fusion

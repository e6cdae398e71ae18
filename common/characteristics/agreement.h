// How far the views of registered sensors differ.  This also shows errors that last, which one
// sensor alone cannot tell from motion.
//
// Two sensors see one joint at one instant; the difference of the two points has, along a unit
// vector e, the variance
//
//   2 across^2 + (along^2 - across^2) ((e.u)^2 + (e.v)^2)
//
// with u and v the two lines of sight.  Each pair is measured along three such e (along u + v,
// along u - v, and perpendicular to both).  The two unknowns follow from all of them by least
// squares: each squared difference is weighted by the inverse square of its expected value.  The
// result includes errors of the registration.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/sensor/sensor_frame.h"

namespace chorus::characteristics {

/// Frames of registered sensors, each in order of capture, by a common clock.
struct PlacedTrack {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  const std::vector<SensorFrame>* frames = nullptr;
};

/// Standard deviations of one view's joint.
struct Agreement {
  double along = 0.0;     ///< Along its line of sight [m].
  double across = 0.0;    ///< Across it, per axis [m].
  std::size_t pairs = 0;  ///< Pairs of one joint of one person, with lines of sight that differ.
};

/// Of the neck and the upper end of the spine, to which fusion attributes no error of the pose.
/// Only frames with one body; None if there are fewer than 100 pairs with lines of sight that
/// differ.
[[nodiscard]] std::optional<Agreement> agreement_of(const std::vector<PlacedTrack>& tracks);

}  // namespace chorus::characteristics

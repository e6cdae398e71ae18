// How the SDK shows a body that turns: it assumes that everybody faces the camera (Otto Figs. 5-6).
//
// Up to `reliable` the yaw shown is right; beyond, that of shoulders and hips lags behind.  Beyond
// flip_to_rear the skeleton is shown as if the person faced the sensor, so left and right are
// swapped; this lasts until the yaw is below flip_to_front again (hysteresis).  When the SDK sees a
// person for the first time, the mean of the two angles decides.
#pragma once

#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// What one sensor's SDK remembers of one body.
struct FlipState {
  bool rear = false;   ///< True while left and right are swapped.
  double blend = 0.0;  ///< 0: front, 1: rear; in between during the transition.
  bool met = false;    ///< True once `rear` has been decided.
};

/// The yaw that the SDK shows for a true yaw [rad] of a person in the front state.  Beyond the
/// reliable angle it grows `slope` times as fast as the true yaw.  Odd and continuous.
[[nodiscard]] double shown_yaw(double yaw, double slope, const YawBehaviour& behaviour);

/// One sensor's own angles: flip_to_rear and flip_to_front of the profile, both moved by the same
/// deviation of up to flip_own, and flip_to_front by a further one of up to flip_back_own, but not
/// above flip_to_rear.
[[nodiscard]] YawBehaviour own_behaviour(YawBehaviour behaviour, std::uint64_t seed,
                                         std::uint64_t sensor);

/// Advances by one frame: decides between the front and the rear state from the true facing angle
/// (0: directly facing the sensor).
void advance(FlipState& state, double facing, double dt, const YawBehaviour& behaviour);

/// The error of the yaw that the SDK shows for the shoulders, apart from swapped labels [rad, >=
/// 0].
[[nodiscard]] double misjudged_yaw(double facing, const FlipState& state,
                                   const YawBehaviour& behaviour);

/// The skeleton as the SDK would show it: all joints but those of the spine are turned about it,
/// and labels are swapped in the rear state.  During the transition joints are in between, and no
/// joint off the spine is tracked.
[[nodiscard]] Skeleton<SensorSpace> as_shown(const Skeleton<SensorSpace>& body, double facing,
                                             const FlipState& state, const YawBehaviour& behaviour);

}  // namespace chorus::synthetic::kinect

// What the SDK makes of a body that turns: it believes that everybody looks at the camera (Otto
// Figs. 5-6).
//
// Up to `reliable` the yaw is right; beyond, shoulders and hips lag; past flip_to_rear the skeleton
// is shown as if it faced the sensor, so left and right are exchanged, and it stays so until the
// yaw is back below flip_to_front (hysteresis).  Whom it sees for the first time it takes to face
// it: nothing of the person's past holds it to an earlier view.
#pragma once

#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// Memory of one body in one sensor.
struct FlipState {
  bool rear = false;   ///< Labels are exchanged.
  double blend = 0.0;  ///< 0 front ... 1 rear, moving while the SDK changes its mind.
  bool met = false;    ///< Has been decided once.
};

/// The yaw the SDK shows for a true yaw [rad] with this slope; odd, continuous, front only.
[[nodiscard]] double shown_yaw(double yaw, double slope, const YawBehaviour& behaviour);

/// One sensor's own angles: the profile's, each off by up to flip_own and flip_back_own.
[[nodiscard]] YawBehaviour own_behaviour(YawBehaviour behaviour, std::uint64_t seed,
                                         std::uint64_t sensor);

/// One frame further: decides the flip from the true facing angle (0 = squarely facing).
void advance(FlipState& state, double facing, double dt, const YawBehaviour& behaviour);

/// By how much the yaw that the SDK shows is wrong, shoulders, exchanged labels aside [rad, >= 0].
[[nodiscard]] double misjudged_yaw(double facing, const FlipState& state,
                                   const YawBehaviour& behaviour);

/// The skeleton as the SDK would show it: trunk and limbs turned about the spine, labels exchanged
/// when flipped.
[[nodiscard]] Skeleton<SensorSpace> as_shown(const Skeleton<SensorSpace>& body, double facing,
                                             const FlipState& state, const YawBehaviour& behaviour);

}  // namespace chorus::synthetic::kinect

// How a body stands in front of the sensor that sees it: the angles of Otto Eqs. (2) and (3).
//
// Sensor space: +z into the scene, +y up.  Radians, metres.
#pragma once

#include <optional>

#include "common/body/skeleton.h"

namespace chorus {

/// Yaw of the body away from facing the sensor squarely, in (-pi, pi]; 0 means chest towards the
/// sensor.  Computed from the line between the shoulders (or the hips, if a shoulder is not seen or
/// that line is vertical) and the horizontal line of sight to the neck (or to SpineBase); none if
/// these joints are not seen or one of the lines is vertical.
[[nodiscard]] std::optional<double> facing_angle(const Skeleton<SensorSpace>& body);

/// Horizontal angle of the neck off the optical axis; none when the neck is not seen.
[[nodiscard]] std::optional<double> bearing_angle(const Skeleton<SensorSpace>& body);

/// Of the joints on the body's centre axis, the bearing that is farthest off the optical axis; none
/// when none of these joints is seen.
[[nodiscard]] std::optional<double> axis_bearing_angle(const Skeleton<SensorSpace>& body);

/// Distance from the sensor to the neck [m]; none when the neck is not seen.
[[nodiscard]] std::optional<double> neck_distance(const Skeleton<SensorSpace>& body);

}  // namespace chorus

// What an error predictor knows of a joint in a view: the heuristics of Otto et al., Section 6.
//
// The paper names the state, the angle between person and sensor, the distance, and the periphery
// of the sensor.  All are taken from the view as fusion gets it, with left and right resolved.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "fusion-server/flow/person.h"

namespace chorus::fusion {

enum class Feature : std::uint8_t {
  Inferred,   ///< 1 if the joint's state is inferred, 0 if it is tracked.
  Turn,       ///< Angle between the person's front and the direction to the sensor, [0, pi] [rad].
  Side,       ///< Sine of the same angle with its sign: which side of the body is farther away.
  Distance,   ///< Sensor to joint [m].
  Periphery,  ///< Horizontal angle of the joint off the optical axis, >= 0 [rad].
  Elevation,  ///< Angle of the joint above the sensor's horizon [rad].
  Untracked,  ///< Share of the view's joints that are not tracked, [0, 1].
};
inline constexpr std::size_t kFeatureCount = 7;

/// The names in a model file, in the order of Feature.
inline constexpr std::array<std::string_view, kFeatureCount> kFeatureNames{
    "inferred", "turn_rad", "side", "distance_m", "periphery_rad", "elevation_rad", "untracked"};

/// Indexed by Feature; NaN: unknown.
using Features = std::array<double, kFeatureCount>;

/// Features of a joint that is a point in the view.
[[nodiscard]] Features features_of(const SensorView& view, JointId joint);

}  // namespace chorus::fusion

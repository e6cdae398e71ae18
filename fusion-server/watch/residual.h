// The distance between where one sensor and the other sensors see the same person.
#pragma once

#include <set>
#include <vector>

#include <Eigen/Core>

#include "fusion-server/flow/person.h"

namespace chorus::watch {

/// How one sensor's view of one person at one instant differs from the views of the others.
struct Residual {
  SensorId sensor;
  std::set<SensorId> others;  ///< The other sensors that saw the person's trunk.
  /// This sensor's view minus that of the others, mean over the body [m], along three axes:
  /// horizontally away from this sensor; horizontally across that (up x away); up.
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();
  double distance = 0.0;   ///< Horizontal distance from the sensor to the person [m].
  double direction = 0.0;  ///< Direction from the sensor to the person: atan2(x, z) in world [rad].
  /// The person's yaw away from facing this sensor, positive about +y [rad].
  double front = 0.0;
};

/// The middle of a person's trunk: the median of each coordinate over the trunk's points in all
/// views; none if no view shows such a point.
[[nodiscard]] std::optional<Eigen::Vector3d> middle_of(const Person& person);

/// The person with only those views in which nobody else stands near them or near the line of
/// sight, because a sensor mixes up people who hide one another.  `others`: the middles of all
/// other people.
[[nodiscard]] Person seen_clearly(const Person& person, const std::vector<Eigen::Vector3d>& others);

/// One residual for each sensor that sees the trunk of this person together with another sensor.
/// Empty if the person's front is unknown.  Uses points that swapping left and right does not
/// affect; rays are left out, and so are joints whose depth was guessed.
[[nodiscard]] std::vector<Residual> residuals_of(const Person& person);

}  // namespace chorus::watch

// How far an estimated place of a sensor is from the true one.
#pragma once

#include <Eigen/Geometry>

namespace chorus::bench {

struct PlaceError {
  double position = 0.0;    ///< [m]
  double horizontal = 0.0;  ///< Of it, across the true vertical [m]
  double vertical = 0.0;    ///< Of it, along the true vertical [m]
  double yaw = 0.0;         ///< About the true vertical [rad]
  double pitch_roll = 0.0;  ///< Tilt of the vertical [rad]
};

/// Estimated against true.  World-from-sensor places, or sensor-from-sensor ones with `up` = the
/// target sensor's own up.
[[nodiscard]] PlaceError place_error(const Eigen::Isometry3d& estimated,
                                     const Eigen::Isometry3d& exact,
                                     const Eigen::Vector3d& up = Eigen::Vector3d::UnitY());

/// Where the estimate puts a point that the sensor sees exactly there [m].
[[nodiscard]] double point_error(const Eigen::Isometry3d& estimated, const Eigen::Isometry3d& exact,
                                 const Eigen::Vector3d& x_in_target);

}  // namespace chorus::bench

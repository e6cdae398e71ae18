// How far a sensor's estimated pose is from the true one.
#pragma once

#include <Eigen/Geometry>

namespace chorus::bench {

struct PlaceError {
  double position = 0.0;    ///< [m]
  double horizontal = 0.0;  ///< Part of the position error across the true vertical [m]
  double vertical = 0.0;    ///< Part of the position error along the true vertical [m]
  double yaw = 0.0;         ///< Error about the true vertical [rad]
  double pitch_roll = 0.0;  ///< Tilt of the vertical [rad]
};

/// Compares estimate and truth: world-from-sensor poses, or sensor-from-sensor poses with `up` =
/// the target sensor's own up.
[[nodiscard]] PlaceError place_error(const Eigen::Isometry3d& estimated,
                                     const Eigen::Isometry3d& exact,
                                     const Eigen::Vector3d& up = Eigen::Vector3d::UnitY());

/// Error of a point that the sensor sees exactly, moved into the world by the estimate [m].
[[nodiscard]] double point_error(const Eigen::Isometry3d& estimated, const Eigen::Isometry3d& exact,
                                 const Eigen::Vector3d& x_in_target);

}  // namespace chorus::bench

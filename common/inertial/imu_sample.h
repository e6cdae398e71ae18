// One sample of a raw inertial sensor, as orientation filters take it.
//
// Filters work in the sensor's own physics: their world is east, north, up (+z up), and their
// result is enu_from_sensor.  y_up_from_z_up() of inertial_frame.h turns it into inertial space.
#pragma once

#include <optional>

#include <Eigen/Core>

namespace chorus::inertial {

struct ImuSample {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< Angular rate [rad/s].
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< Specific force [m/s^2].
  std::optional<Eigen::Vector3d> field = {};  ///< Magnetic field, in any one unit; absent: none.
};

}  // namespace chorus::inertial

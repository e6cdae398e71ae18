// Where cameras stand, from a file in the form of a fusion server's registration.file.
#pragma once

#include <map>
#include <string>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::positioner {

/// world_from_sensor by the names of the sensors.  Malformed, naming the sensor: missing numbers,
/// no unit quaternion, places more than 1 km away.
[[nodiscard]] Result<std::map<std::string, Eigen::Isometry3d>> read_places(std::string_view json);

}  // namespace chorus::positioner

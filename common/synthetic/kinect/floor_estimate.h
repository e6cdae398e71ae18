// The floor plane as a sensor's SDK estimates it.
#pragma once

#include <cstdint>

#include "common/sensor/sensor_frame.h"
#include "common/synthetic/kinect/joint_error.h"

namespace chorus::synthetic::kinect {

/// A fixed error per sensor and a little per frame; `keys.person` does not matter.
[[nodiscard]] FloorPlane estimated_floor(const Eigen::Isometry3d& world_from_sensor,
                                         std::uint64_t number, const FloorError& error,
                                         const ErrorKeys& keys);

}  // namespace chorus::synthetic::kinect

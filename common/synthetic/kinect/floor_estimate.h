// The floor plane as a sensor's SDK estimates it.
#pragma once

#include <cstdint>

#include "common/sensor/sensor_frame.h"
#include "common/synthetic/kinect/joint_error.h"

namespace chorus::synthetic::kinect {

/// Adds an error that is constant for the sensor and a small one that changes from frame to frame.
/// `keys.person` is not used.
[[nodiscard]] FloorPlane estimated_floor(const Eigen::Isometry3d& world_from_sensor,
                                         std::uint64_t number, const FloorError& error,
                                         const ErrorKeys& keys);

}  // namespace chorus::synthetic::kinect

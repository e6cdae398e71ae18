// Systematic joint error that depends on how the body stands before the sensor (Otto Figs. 7-8).
//
// Sensor-polar frame at the joint: radial (horizontally away from the sensor), lateral (to the
// sensor's left), up. Harmonics of the facing angle with coefficients that belong partly to the SDK
// (all people) and partly to the person.
#pragma once

#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

struct BiasKeys {
  std::uint64_t sdk = 1;  ///< The same for every sensor and person of one draw.
  std::uint64_t person = 1;
};

/// Error of one joint [m] in sensor space, to be added to its position.
[[nodiscard]] Eigen::Vector3d joint_bias(JointId id, const Eigen::Vector3d& joint, double facing,
                                         const JointBias& bias, const BiasKeys& keys);

}  // namespace chorus::synthetic::kinect

// Systematic joint error that depends on how the body stands before the sensor (Otto Figs. 7-8).
//
// Sensor-polar frame at the joint: radial (horizontally away from the sensor), lateral (to the
// sensor's left), up. Harmonics of the facing angle with coefficients that belong partly to the SDK
// (all people) and partly to the person.  A joint with a leader errs mostly as that one does.
#pragma once

#include <array>
#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

struct BiasKeys {
  std::uint64_t sdk = 1;  ///< The same for every sensor and person of one draw.
  std::uint64_t person = 1;
};

/// Coefficients of one joint, of unit size.
struct Harmonics {
  double radial1 = 0, radial2 = 0, lateral1 = 0, lateral2 = 0, up0 = 0, up1 = 0;
};
using PersonHarmonics = std::array<Harmonics, kJointCount>;

/// SDK part and personal part, mixed by share: drawn once per person.
[[nodiscard]] PersonHarmonics harmonics_of(const JointBias& bias, const BiasKeys& keys);

/// Error of one joint [m] in sensor space, to be added to its position.
[[nodiscard]] Eigen::Vector3d joint_bias(JointId id, const Eigen::Vector3d& joint, double facing,
                                         const JointBias& bias, const PersonHarmonics& harmonics);

/// Its mean square over people and SDKs [m^2].
[[nodiscard]] Eigen::Matrix3d bias_moment(JointId id, const Eigen::Vector3d& joint, double facing,
                                          const JointBias& bias);

}  // namespace chorus::synthetic::kinect

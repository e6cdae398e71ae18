// Systematic joint error that depends on how the body is turned to the sensor (Otto Figs. 7-8).
//
// The error is given along three directions at the joint: radial (horizontally away from the
// sensor), lateral (to the sensor's left) and up.  Each is a sum of harmonics of the facing angle;
// the coefficients are partly the SDK's, equal for all people, and partly the person's own.  A
// joint with a leader (leader.h) has mostly the leader's error.
#pragma once

#include <array>
#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

struct BiasKeys {
  std::uint64_t sdk = 1;  ///< Seed of the SDK's part; the same for every sensor and person.
  std::uint64_t person = 1;
};

/// Coefficients of one joint, before they are multiplied by the sizes in JointBias.
struct Harmonics {
  double radial1 = 0, radial2 = 0, lateral1 = 0, lateral2 = 0, up0 = 0, up1 = 0;
};
using PersonHarmonics = std::array<Harmonics, kJointCount>;

/// Draws a person's coefficients: a mixture of the SDK's and the person's own.
[[nodiscard]] PersonHarmonics harmonics_of(const JointBias& bias, const BiasKeys& keys);

/// Error of one joint [m] in sensor space, to be added to its position.
[[nodiscard]] Eigen::Vector3d joint_bias(JointId id, const Eigen::Vector3d& joint, double facing,
                                         const JointBias& bias, const PersonHarmonics& harmonics);

/// The mean square of joint_bias() over people and SDKs [m^2].
[[nodiscard]] Eigen::Matrix3d bias_moment(JointId id, const Eigen::Vector3d& joint, double facing,
                                          const JointBias& bias);

}  // namespace chorus::synthetic::kinect

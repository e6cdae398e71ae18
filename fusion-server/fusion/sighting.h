// One view's sight of one joint, and what becomes of several of them.
#pragma once

#include <cstdint>

#include "common/body/skeleton.h"
#include "fusion-server/fusion/noise_model.h"

namespace chorus::fusion {

/// Only seen joints become sightings.  World space.
struct Sighting {
  Joint joint;
  double weight = 0.0;                            ///< Of the view, Eqs. (1)-(3); >= 0.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Sensor position [m].
  NoiseModel noise;
  std::uint64_t contributor = 0;  ///< The sensor's bit in FusedBody::contributors.
};

struct FusedJoint {
  Joint joint;            ///< NotTracked with zero position when nothing could be fused.
  double variance = 0.0;  ///< Mean per-axis variance [m^2].
  std::uint64_t contributors = 0;
};

/// Standard deviations usable as divisors: never below a tenth of a millimetre, inferred joints
/// widened.
[[nodiscard]] NoiseModel noise_of(const Sighting& sighting);

}  // namespace chorus::fusion

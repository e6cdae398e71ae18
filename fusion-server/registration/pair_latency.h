// How much later one sensor's stamps are than another's, for clocks that are known: latency.
//
// Once the pair has a place, what is left between its views is regressed on the velocity of the
// joints:  r = x_source - x_target = t + omega x X - (latency_source - latency_target) v,  each
// frame whitened by the one before it, joints weighted across and along both lines of sight, frames
// by a Student-t.  The place (omega, t) is free again, so a motion that cannot tell latency from a
// place (a uniform circle) gives a large sigma.  docs/papers/registration.md, Section 12.
#pragma once

#include <optional>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

struct PairLatency {
  double latency = 0.0;  ///< The source's minus the target's [s].
  double sigma = 0.0;    ///< Standard deviation [s].
};

/// Both walkers come from offset_walker().  None if too little was seen together.
[[nodiscard]] std::optional<PairLatency> pair_latency(const Walker& target, const Walker& source,
                                                      const Eigen::Isometry3d& target_from_source,
                                                      const RegistrationConfig& config);

}  // namespace chorus::registration

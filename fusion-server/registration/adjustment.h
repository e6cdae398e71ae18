// All sensors at once: bundle adjustment over the walk with the person's points eliminated.
//
//   minimise over places T_i and points x_k:  sum w (T_i m_ik - x_k)^T S_ik^-1 (T_i m_ik - x_k)
//
// with S_ik sharp across and blunt along each line of sight, Tukey weights, and the floor as prior.
// Given the places, each x_k is the inverse-variance mean, so only the places stay unknown.  Pairs
// of depth sensors gain little from it; single cameras, which hardly know depth, gain much: three
// lines of sight fix what two leave open.  Derived in docs/papers/registration.md, Section 8.
#pragma once

#include <map>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// master_from_sensor of every linked sensor, the master included.
using Places = std::map<SensorId, Eigen::Isometry3d>;

struct Walkers {
  const std::map<SensorId, Walker>& all;
  SensorId master;         ///< Stays where it is.
  double inflation = 1.0;  ///< Measurements per independent measurement.
};

/// Starts from `places`, and returns them unchanged if nothing gets better.
[[nodiscard]] Places adjust_together(const Places& places, const Walkers& walkers,
                                     const RegistrationConfig& config);

}  // namespace chorus::registration

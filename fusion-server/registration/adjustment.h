// All sensors at once: bundle adjustment over the walk, with the person's points eliminated.
//
//   minimise over places T_i and points x_k:  sum w (T_i m_ik - x_k)^T S_ik^-1 (T_i m_ik - x_k)
//
// with S_ik small across and large along each line of sight, Tukey weights, and the floor as a
// prior.  Given the places, each x_k is the inverse-variance mean, so only the places are unknown.
// Pairs of depth sensors gain little; single cameras, whose depth is inaccurate, gain much: three
// lines of sight fix what two leave open.  Derived in docs/papers/registration.md, Section 8.
#pragma once

#include <map>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// master_from_sensor for every linked sensor, including the master.
using Places = std::map<SensorId, Eigen::Isometry3d>;

struct Walkers {
  const std::map<SensorId, Walker>& all;
  SensorId master;         ///< It is not moved.
  double inflation = 1.0;  ///< Correlation: measurements per independent measurement.
};

/// Starts from `places`; returns them unchanged if the result is not better.
[[nodiscard]] Places adjust_together(const Places& places, const Walkers& walkers,
                                     const RegistrationConfig& config);

}  // namespace chorus::registration

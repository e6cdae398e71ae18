// All sensors at once: bundle adjustment over the walk, with the person's points eliminated.
//
//   minimise over places T_i and points x_k:
//     sum w (T_i m_ik - x_k)^T S_ik^-1 (T_i m_ik - x_k) / v + sum over floors (tilt, height)
//
// with S_ik small across and large along each line of sight, Tukey weights w, the variance factor v
// (block_variance.h), and each sensor's floor as a prior of its own tilt and height.  Given the
// places, each x_k is the inverse-variance mean, so only the places are unknown.  No measurement
// determines the world's position along the floor and its yaw.  They are held at those of the
// master; nothing else of the master is held.  Derived in docs/papers/registration.md, Section 8.
#pragma once

#include <map>
#include <optional>

#include "common/geometry/plane.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/registration/adjoint.h"
#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// world_from_sensor for every linked sensor, including the master.
using Places = std::map<SensorId, Eigen::Isometry3d>;

struct Walkers {
  const std::map<SensorId, Walker>& all;
  SensorId master;
  /// The master's floor where no sensor reports one: a guess, to which the master is held.
  std::optional<FloorPlane> guessed = {};
  Stopped stopped = {};  ///< Asked before each iteration.
};

struct Adjusted {
  Places places;  ///< The world is level, with its origin on the floor.
  /// Covariances of (omega, tau), applied on the world's side; only for sensors that took part.
  std::map<SensorId, Matrix6> covariances;
  Eigen::MatrixXd together;  ///< The same of all places with each other, in their order.
  /// The configured depth bias, as corrected by the walk; or a large one that the walk shows, see
  /// found_bias.
  WalkedDepthBias depth_bias;
  /// True if no depth bias was configured, and the walk shows one above 30 mm and 3.5 sigma.
  bool found_bias = false;
};

/// Starts from `places`.  None if nothing was seen together, if the result fits the walk and the
/// floors worse than `places` do, if it moves a sensor by 0.5 m * max(2, along_ratio) or more, or
/// if it was stopped.
[[nodiscard]] std::optional<Adjusted> adjust_together(const Places& places, const Walkers& walkers,
                                                      const RegistrationConfig& config);

}  // namespace chorus::registration

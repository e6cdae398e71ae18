// Baselines that filter over time with a constant-velocity Kalman filter per joint.
//
// Process: white acceleration of density q; x = (p, v), P the same on every axis because all noise
// is isotropic.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fusion-server/registration/registration.h"
#include "tests/bench/baselines/baseline.h"

namespace chorus::bench::baselines {

/// One point that moves; asynchronous: every update has its own time.
class PointFilter {
 public:
  explicit PointFilter(double density) : density_(density) {}

  /// A sight of the point at `instant`, `variance` per axis [m^2].  Starts afresh after kForgotten.
  void update(Timestamp instant, const Eigen::Vector3d& position, double variance);
  /// Where it should be at `instant`, or at its last update when that is later; none before the
  /// first.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(Timestamp instant) const;
  [[nodiscard]] const Eigen::Vector3d& velocity() const { return velocity_; }  ///< [m/s]
  [[nodiscard]] double position_variance() const { return covariance_(0, 0); }

 private:
  void predict(double dt);

  double density_;  ///< [m^2 / s^3]
  std::optional<Timestamp> updated_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

inline constexpr Duration kForgotten = std::chrono::milliseconds(500);

/// Density for a joint: 3 for the trunk, 40 for limbs [m^2 / s^3].
[[nodiscard]] double process_density(JointId joint);

/// F: Otto's weights in a linear Kalman filter: every view updates with R = R0 / (w + 0.02), R0 =
/// (20 mm)^2.
[[nodiscard]] Method otto_kalman();

/// A body as a tracker states it, with the time it states for it.
struct Stated {
  Timestamp instant;
  PersonId id;
  Body body;
};

/// The way of OpenPTrack: each frame updates its person's joints as it arrives, by the time of
/// arrival, and the answer bears that time (but with the real elapsed time instead of a
/// fixed one, and noise to fit the sensors: 25 mm, 75 mm where inferred).  One answer per frame and
/// person, in order; left and right are put right from frame to frame.  `received` of the frames
/// must be set.
[[nodiscard]] std::vector<Stated> arrival_kalman(
    const std::vector<registration::WalkTrack>& sensors, const Registration& registration);

}  // namespace chorus::bench::baselines

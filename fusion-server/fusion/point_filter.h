// A constant-velocity Kalman filter of one point.
//
// State (p, v) per axis; process: white acceleration of density q:
//   Q = q [dt^3/3 dt^2/2; dt^2/2 dt]
// P is the same on every axis because all noise is isotropic.  Metres, seconds.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/time/timestamp.h"

namespace chorus::fusion {

/// [m/s] standard deviation of a velocity not yet measured.
inline constexpr double kFirstSpeed = 1.0;

/// Accepts measurements at any times, in order.
class PointFilter {
 public:
  /// After a time longer than this without measurements, the filter starts anew.
  static constexpr Duration kForgotten = std::chrono::milliseconds(500);

  explicit PointFilter(double density) : density_(density) {}  ///< [m^2 / s^3]

  /// Takes a measurement of the point at `instant`, with `variance` per axis [m^2].
  void update(Timestamp instant, const Eigen::Vector3d& position, double variance);
  /// Predicted position at `instant`, or at the last update if that is later; nothing before the
  /// first update.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(Timestamp instant) const;
  /// Variance of at(instant) per axis [m^2]; zero before the first update.
  [[nodiscard]] double variance_at(Timestamp instant) const;
  [[nodiscard]] const Eigen::Vector3d& velocity() const { return velocity_; }  ///< [m/s]
  [[nodiscard]] double position_variance() const { return covariance_(0, 0); }

 private:
  void predict(double dt);

  double density_;
  std::optional<Timestamp> updated_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

}  // namespace chorus::fusion

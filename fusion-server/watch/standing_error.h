// The constant error of one sensor: the error of its registered place, and the errors of tracking
// that depend on a person's orientation towards the sensor.
//
// A Kalman filter over ten numbers that change slowly (docs/papers/watch.md (1)):
//   away   = x sin d + z cos d + a0 + a1 cos f + a2 cos 2f
//   across = x cos d - z sin d + r yaw + b1 sin f + b2 sin 2f
//   up     = y + c1 cos f
// with the person at distance r and direction d, turned by f.
#pragma once

#include <Eigen/Core>

#include "fusion-server/watch/residual.h"

namespace chorus::watch {

/// Order: yaw [rad]; x, y, z [m]; a0, a1, a2; b1, b2; c1 [m].
inline constexpr int kParameters = 10;
/// The first four are errors of the place, the others of the tracker.
inline constexpr int kRigid = 4;
using Parameters = Eigen::Matrix<double, kParameters, 1>;
using Rows = Eigen::Matrix<double, 3, kParameters>;

[[nodiscard]] Rows rows_of(const Residual& residual);

/// The mean of several residuals of one sensor.
struct Block {
  Timestamp begin;
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();
  Rows rows = Rows::Zero();
  std::set<SensorId> others;
};

class StandingError {
 public:
  StandingError();

  /// Learns from one block; an outlying one counts less.
  void learn(const Block& block);

  /// The block's mean residual minus the constant error [m].
  [[nodiscard]] Eigen::Vector3d news(const Block& block) const {
    return block.apart - block.rows * state_;
  }
  /// Covariance of the estimate of the constant error that `rows` (see rows_of()) predict [m^2].
  [[nodiscard]] Eigen::Matrix3d uncertainty(const Rows& rows) const {
    return rows * covariance_ * rows.transpose();
  }
  /// The part of that error which comes from the sensor's place: estimate [m] and covariance [m^2].
  [[nodiscard]] Eigen::Vector3d of_place(const Rows& rows) const;
  [[nodiscard]] Eigen::Matrix3d uncertainty_of_place(const Rows& rows) const;

 private:
  Parameters state_ = Parameters::Zero();
  Eigen::Matrix<double, kParameters, kParameters> covariance_;
};

}  // namespace chorus::watch

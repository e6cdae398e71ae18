#include "fusion-server/watch/standing_error.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/units.h"

namespace chorus::watch {
namespace {

/// Prior standard deviations: the usual errors of a registration and of a tracker.
Parameters first_sigmas() {
  constexpr double kYaw = deg(0.6);
  constexpr double kPlace = 0.025;
  constexpr double kTracking = 0.012;
  Parameters sigmas = Parameters::Constant(kTracking);
  sigmas.head<kRigid>() << kYaw, kPlace, kPlace, kPlace;
  return sigmas;
}

/// Standard deviations of the change from one block to the next (half a second of walking): some
/// centimetres in a working day.
Parameters steps() {
  constexpr double kYaw = deg(0.004);
  constexpr double kPlace = 0.00015;
  Parameters sigmas = Parameters::Constant(kPlace);
  sigmas[0] = kYaw;
  return sigmas;
}

// Standard deviation of a block's mean [m]; wide, because errors last longer than a block.
constexpr double kBlockSigma = 0.018;
constexpr double kOutlier = 3.0;  // [sigma]

}  // namespace

Rows rows_of(const Residual& residual) {
  const double x = std::sin(residual.direction);
  const double z = std::cos(residual.direction);
  const double f = residual.front;
  Rows rows;
  // clang-format off
  rows << 0.0,               x,   0.0, z,   1.0, std::cos(f), std::cos(2 * f), 0.0, 0.0, 0.0,
          residual.distance, z,   0.0, -x,  0.0, 0.0, 0.0, std::sin(f), std::sin(2 * f), 0.0,
          0.0,               0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, std::cos(f);
  // clang-format on
  return rows;
}

StandingError::StandingError() : covariance_(first_sigmas().cwiseAbs2().asDiagonal()) {}

void StandingError::learn(const Block& block) {
  static const Parameters kSteps = steps().cwiseAbs2();
  covariance_.diagonal() += kSteps;
  const Eigen::Vector3d off = news(block);
  Eigen::Matrix3d spread = uncertainty(block.rows);
  spread.diagonal().array() += kBlockSigma * kBlockSigma;
  const double sigmas = std::sqrt(off.dot(spread.ldlt().solve(off)));
  const double doubt = std::max(1.0, sigmas / kOutlier);
  spread.diagonal().array() += (doubt * doubt - 1.0) * kBlockSigma * kBlockSigma;
  const Eigen::Matrix<double, kParameters, 3> gain =
      covariance_ * block.rows.transpose() * spread.inverse();
  state_ += gain * off;
  covariance_ -= gain * block.rows * covariance_;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose().eval());
}

Eigen::Vector3d StandingError::of_place(const Rows& rows) const {
  return rows.leftCols<kRigid>() * state_.head<kRigid>();
}

Eigen::Matrix3d StandingError::uncertainty_of_place(const Rows& rows) const {
  return rows.leftCols<kRigid>() * covariance_.topLeftCorner<kRigid, kRigid>() *
         rows.leftCols<kRigid>().transpose();
}

}  // namespace chorus::watch

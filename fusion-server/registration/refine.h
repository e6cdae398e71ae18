// Six degrees of freedom with the floor as a prior, and a realistic covariance.
//
// The closed form treats the floor as exact and errors as isotropic.  Here the walk can correct a
// slightly wrong floor, and each sensor is less accurate along its line of sight:
//   minimise sum w r^T S^-1 r / (s^2 kappa) + |tilt|^2 / sigma_tilt^2 + |height|^2 / sigma_height^2
//   S = sigma^2 / 2 (A_target + R A_source R^T),   A = I + (ratio^2 - 1) ray ray^T
// with Tukey weights w and their scale s.  kappa = max(1, j) (1 + rho) / (1 - rho) accounts for the
// correlation of successive instants (rho) and of the joints at one instant (j); without it the
// walk would outweigh the floor, and the covariance would be too small by the same factor.  Derived
// in docs/papers/registration.md, Section 4.
#pragma once

#include "fusion-server/registration/floor_prior.h"
#include "fusion-server/registration/robust_fit.h"

namespace chorus::registration {

struct Refined {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  std::vector<double> weights;  ///< Per pair, in [0, 1]; zero for outliers.
  /// Covariance of (omega, tau), applied on the target side.
  Matrix6 covariance = Matrix6::Zero();
  double scale = 1.0;      ///< Standard deviation of a pair, in units of its sigma.
  double inflation = 1.0;  ///< Pairs per independent pair; above one because pairs are correlated.
};

/// Starts from the robust fit.
[[nodiscard]] Refined refine(const std::vector<Pair>& pairs, const RobustFit& fit,
                             const FloorPrior& prior, double along_ratio);

/// sum w r^T S^-1 r with the pose and the weights of `at`: shows how well the pose fits the pairs.
[[nodiscard]] double cost_of(const std::vector<Pair>& pairs, const Refined& at, double along_ratio);

/// rms residual over the pairs with positive weight [m]; for messages and thresholds.
[[nodiscard]] double rms_of(const std::vector<Pair>& pairs, const std::vector<double>& weights,
                            const Eigen::Isometry3d& target_from_source);

}  // namespace chorus::registration

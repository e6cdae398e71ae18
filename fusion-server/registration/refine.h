// Six degrees of freedom with the floor as a prior, and a covariance that does not flatter
// (notes 1.4, 1.6).
//
// The closed form holds the floor for exact.  Here a floor that is a little wrong yields to the
// walk: minimise sum w |r|^2 / (s^2 kappa) + |tilt|^2 / sigma_tilt^2 + |height|^2 / sigma_height^2.
// kappa = (1 + rho) / (1 - rho) because successive residuals are not independent; without it the
// walk would overrule the floor, and the covariance would be too small by the same factor.
#pragma once

#include "fusion-server/registration/adjoint.h"
#include "fusion-server/registration/robust_fit.h"

namespace chorus::registration {

/// How far two levelled frames may differ in pitch, roll and height.  Each floor is good to 0.4 deg
/// and 10 mm (notes 1.4 step 1); two of them differ by sqrt(2) more.
struct FloorPrior {
  double tilt = 0.0;    ///< [rad] per axis; 0: no prior
  double height = 0.0;  ///< [m]; 0: no prior
};

struct Refined {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Matrix6 covariance = Matrix6::Zero();  ///< Of (omega, tau) applied on the target side.
  double inflation = 1.0;                ///< Pairs per independent pair.
};

/// Starts from the robust fit and keeps its weights.
[[nodiscard]] Refined refine(const std::vector<Pair>& pairs, const RobustFit& fit,
                             const FloorPrior& prior);

/// rms residual over the pairs with positive weight [m]; the yardstick for every refinement.
[[nodiscard]] double rms_of(const std::vector<Pair>& pairs, const std::vector<double>& weights,
                            const Eigen::Isometry3d& target_from_source);

/// Pairs per independent pair: lag-1 autocorrelation of the mean residual of an instant, times the
/// correlation of the joints within an instant.  At least 1.
[[nodiscard]] double inflation_of(const std::vector<Pair>& pairs, const RobustFit& fit);

}  // namespace chorus::registration

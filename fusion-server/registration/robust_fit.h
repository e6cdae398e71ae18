// A robust closed-form rigid fit: graduated non-convexity, then Tukey re-weighting.
//
// Needs no initial guess, and tolerates more than half of the pairs being wrong, if they are wrong
// in different ways.  Derived in docs/papers/registration.md, Section 3.
#pragma once

#include <vector>

#include "common/geometry/rigid_fit.h"
#include "fusion-server/registration/pairs.h"

namespace chorus::registration {

enum class Freedom {
  Yaw,   ///< Both sides are levelled: rotation about +y and translation.
  Full,  ///< Six degrees of freedom.
};

struct RobustFit {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  std::vector<double> weights;  ///< Per pair, in [0, 1]; zero for outliers.
  double rms = 0.0;             ///< Residual over the pairs with positive weight [m].
  double scale = 0.0;           ///< Per-axis standard deviation in units of the pairs' own sigma.
  std::size_t inliers = 0;
};

/// `sigma_factor` scales the pairs' sigmas to the expected ones; it is doubled, at most five times,
/// until half of the pairs are inliers, so that with noisy sensors the fit does not follow a lucky
/// few.
[[nodiscard]] Result<RobustFit> fit_robustly(const std::vector<Pair>& pairs, Freedom freedom,
                                             double sigma_factor = 1.0);

}  // namespace chorus::registration

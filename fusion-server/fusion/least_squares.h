// Robust least squares over the points and rays of one joint.
//
// A point z constrains all three axes, with its covariance Sigma.  A ray from an eye along the unit
// direction d constrains the two axes across it: at range r = d . (p - eye) its direction's
// covariance C [rad^2] becomes r^2 C [m^2].
//   p = argmin sum_i rho(|p - z_i|_Sigma_i)
//
// is solved by Gauss-Newton with re-weighting.  The influence of a measurement grows like Huber's
// up to `huber`, then stays constant, and fades beyond 5 standard deviations.  That is not convex:
// where three or more measurements contradict each other, single ones and pairs are tried as starts
// (docs/papers/rays.md).
#pragma once

#include <optional>
#include <span>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {

struct LeastSquares {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Inverse information, times the squared scale of the residuals where that exceeds one [m^2].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<double> trust;  ///< Per view, in [0, 1]; 0: the joint is behind this camera.
  std::vector<double> pull;   ///< Per view: by how much it determines the position; sums to 1.
};

/// Nothing when the views do not determine a point: no views, or only rays that leave depth open.
/// `huber` is in standard deviations; 0: no robust loss.
[[nodiscard]] std::optional<LeastSquares> least_squares(std::span<const JointView> views,
                                                        double huber);

}  // namespace chorus::fusion

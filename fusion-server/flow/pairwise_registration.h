// How two sensors stand to each other.
#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"

namespace chorus {

/// An edge: the registration of one overlapping pair, with the direction in which it was computed;
/// code that needs the reverse inverts it explicitly.
struct PairwiseRegistration {
  SensorId target;
  SensorId source;
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double rms = 0.0;       ///< Residual over the inliers [m].
  double icp_rms = 0.0;   ///< Residual after ICP refinement [m].
  std::size_t pairs = 0;  ///< Time-paired correspondences.
  std::size_t inliers = 0;
  double spread = 0.0;  ///< RMS distance of the walk from its centroid, along its two longest
                        ///< principal axes [m].
  /// Distance between where this pair alone and where all pairs together place a person in front of
  /// the source [m]; none: not known.
  std::optional<double> apart = {};
  /// The worst closure error of the loops that the edge forms with two other edges [m]; none: it is
  /// in no such loop.
  std::optional<double> loop = {};
  /// By how much the worst of these loops turns [rad]; need not be the loop of `loop`.
  std::optional<double> loop_turn = {};
  double inflation = 1.0;  ///< Number of pairs per independent pair; above 1 because pairs are
                           ///< correlated.
  /// Covariance of a small motion (omega, tau) on the target side: exp(omega), then tau [rad^2, rad
  /// m, m^2].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace chorus

// Closed-form rigid fit of paired points: Umeyama without scale, determinant-corrected.
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus {

struct RigidFit {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double rms = 0.0;  ///< Weighted root mean square residual [m].
};

/// Minimises sum w |target - target_from_source * source|^2 over rotation and translation.  Needs
/// three pairs that are not on one line.  Weights must be finite and >= 0; if `weights` is empty,
/// all are 1.
[[nodiscard]] Result<RigidFit> fit_rigid(std::span<const Eigen::Vector3d> source,
                                         std::span<const Eigen::Vector3d> target,
                                         std::span<const double> weights = {});

/// Like fit_rigid(), but rotates about +y only (both sides are levelled); two pairs that differ
/// horizontally suffice.
[[nodiscard]] Result<RigidFit> fit_yaw(std::span<const Eigen::Vector3d> source,
                                       std::span<const Eigen::Vector3d> target,
                                       std::span<const double> weights = {});

}  // namespace chorus

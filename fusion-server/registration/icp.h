// Iterative closest point on neck clouds, by PCL (Otto 5.2, 5.2.1; docs/papers/registration.md,
// Section 5).
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::registration {

using Cloud = std::span<const Eigen::Vector3d>;

struct IcpFit {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  /// rms distance to the nearest target point, over the points that are kept [m].
  double rms = 0.0;
  std::size_t accepted = 0;
};

/// Point-to-point refinement from a good start. Points farther than `reach` from all target points
/// do not influence the transform, but count in its rms. None when there are too few points or it
/// does not converge.
[[nodiscard]] std::optional<IcpFit> refine_by_icp(Cloud source, Cloud target,
                                                  const Eigen::Isometry3d& start, double reach);

/// The published method as far as it is described: levelled clouds without time stamps or an
/// initial guess.  Tries 24 yaws about the centroids, keeps the best 90 % of the correspondences,
/// and returns the result with the smallest residual.
[[nodiscard]] Result<IcpFit> icp_from_yaw_seeds(Cloud source, Cloud target);

}  // namespace chorus::registration

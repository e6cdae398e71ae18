// Relative poses of cameras from rays: by OpenCV, from two views (essential matrix) and from points
// that are known (perspective-n-point).  Both leave outliers out.
//
// The rays of one camera count as normalised image points (x/z, y/z); those that do not point
// forwards are left out.  Nister 2004 (five points), Lepetit et al. 2009 (EPnP).
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::registration {

/// Two cameras and what they saw together.
struct TwoViews {
  Eigen::Isometry3d first_from_second = Eigen::Isometry3d::Identity();  ///< |t| = 1.
  std::size_t common = 0;                                               ///< Rays that both have.
  std::size_t agreeing = 0;  ///< Of these, rays that meet in front of both.
  double parallax = 0.0;     ///< Median angle between rays that agree [rad].
  double beyond_turn = 0.0;  ///< What is left of it if the cameras were only turned [rad].
};

/// Rays of the same joints at the same instants, in either camera's own space.
struct CommonRays {
  std::vector<Eigen::Vector3d> first;
  std::vector<Eigen::Vector3d> second;
};

/// Errors: NotFound, they have fewer than kLeastCommon rays in common; Unavailable, no essential
/// matrix fits them.
[[nodiscard]] Result<TwoViews> two_views(const CommonRays& rays);

/// Points and the rays that a camera has to them.
struct KnownPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> rays;
};

struct FoundPlace {
  Eigen::Isometry3d points_from_camera = Eigen::Isometry3d::Identity();
  double agreeing = 0.0;  ///< Share of the rays that pass their points.
};

/// Errors: as two_views().
[[nodiscard]] Result<FoundPlace> place_among(const KnownPoints& known);

/// With fewer common rays nothing is estimated: as RegistrationConfig::min_pairs.
inline constexpr std::size_t kLeastCommon = 60;

}  // namespace chorus::registration

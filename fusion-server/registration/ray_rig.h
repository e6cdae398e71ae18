// A rig of cameras that send rays alone, from one person who walks: where they stand to each other,
// up to a common factor.
//
//   minimise over places T_i and joints x_k: sum rho(angle(r_ik, T_i^-1 x_k) / sigma_k)
//
// The start is a view graph: of each pair the essential matrix, the best pair first, then one
// camera after the other by perspective-n-point.  Then all places and joints together, with
// Cauchy's loss.  What is left open is where the rig stands and how large it is.
// docs/papers/rays.md, "Registration".
#pragma once

#include <map>
#include <string>

#include "common/base/result.h"
#include "fusion-server/registration/ray_points.h"

namespace chorus::registration {

struct RayRig {
  RayPlaces places;  ///< Of the cameras that could be placed; at least two.
  std::vector<RayPoint> points;
  double misfit = 0.0;  ///< Standard deviation of a ray, in units of its sigma.
  std::map<std::size_t, std::string> refused;  ///< Why the other cameras have no place.
};

/// `names`: of the cameras, for messages.  An Error says in a full sentence why no two cameras can
/// be placed: too few common rays, or all look from one place.
[[nodiscard]] Result<RayRig> rig_of(std::vector<RayPoint> points,
                                    const std::vector<std::string>& names);

/// Moves all places but the first to where the rays meet best, and tells which rays count.
/// Returns the standard deviation of a ray in units of its sigma.
double adjust_rays(std::vector<RayPoint>& points, RayPlaces& places, int iterations);

/// Mean squared angle of all rays of placed cameras in their sigmas, each at most the gate's, by
/// which arrangements of the same cameras are compared; `misfit`: of the better one.
[[nodiscard]] double rays_cost(const std::vector<RayPoint>& points, const RayPlaces& places,
                               double misfit);

/// The sum of the distances of all cameras from the first.
[[nodiscard]] double size_of(const RayPlaces& places);

}  // namespace chorus::registration

// Ours instead of the search: Gauss-Newton on the same distance field, with the outline in closed
// form.  Minimises sum rho(D(pi(x_i + delta))) over the shift delta, D: the distance field, x_i:
// the points of the outline, rho: Cauchy's loss.
#pragma once

#include <optional>

#include "common/silhouette/search.h"

namespace chorus::silhouette {

struct OutlineSettings {
  double spacing_px = 5.0;  ///< Of the outline's points [px of the picture].
  double cauchy_px = 8.0;
  double most_shift = 0.15;  ///< Of one step [m].
  /// Standard deviation of how much thicker the person is all around than the shape, by girth and
  /// clothes: it is estimated with the shift, or it would be taken for nearness [m].
  double thickness = 0.015;
  bool over_floor = true;  ///< Only along x and z; the height is the suit's.
  /// Mean distance above which the start is searched on a grid [px].
  double lost_px = 9.0;
  double reach = 0.6;  ///< Of that grid; 0: there is none [m].
};

struct OutlineFit {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();       ///< [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2]
  double mean_px = 0.0;    ///< Mean distance of the outline from the edges.
  double inside = 0.0;     ///< Share of the outline's inner side that is foreground.
  bool ambiguous = false;  ///< Another minimum of the grid was as good to a tenth.
};

/// None when fewer than 20 points of the outline are in the picture, or when most of what the
/// outline encloses is background.
[[nodiscard]] std::optional<OutlineFit> fit_outline(const SearchView& view,
                                                    const OutlineSettings& settings = {});

}  // namespace chorus::silhouette

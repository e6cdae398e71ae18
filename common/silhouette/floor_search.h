// Where on the floor a body stands, when nothing is known before: every place whose hips are seen
// in front of the background is tried (Madaras et al. 3.3, without the start at the board).
#pragma once

#include <optional>
#include <span>

#include "common/silhouette/outline_fit.h"

namespace chorus::silhouette {

struct FloorSearch {
  double step = 0.25;         ///< Of the places that are tried [m].
  double nearest = 0.8;       ///< From the camera, over the floor [m].
  double farthest = 12.0;     ///< [m]
  double least_inside = 0.6;  ///< Share of the outline's inner side that must be foreground.
};

/// How `view.body` must be shifted to fit the picture; its height stays.  None when nobody fits.
[[nodiscard]] std::optional<OutlineFit> find_on_floor(const SearchView& view,
                                                      const FloorSearch& settings = {},
                                                      const OutlineSettings& outline = {});

}  // namespace chorus::silhouette

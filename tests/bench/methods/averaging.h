// Baselines that average views: all, the tracked ones, or the largest cluster of them.
#pragma once

#include <vector>

#include "fusion-server/fusion/fuse.h"
#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// Two sights of a joint closer than this belong together [m] (10 cm as in Lee 2022).
inline constexpr double kClusterReach = 0.1;

/// One of the product's own methods, with what it remembers of one person.
[[nodiscard]] Method product(fusion::FusionConfig config);
[[nodiscard]] Method product(fusion::Method method);

/// D: the mean over the views that track a joint; where none does, over those that guess it.
[[nodiscard]] Method tracked_mean();

/// Groups of points linked by steps of at most `reach`, largest first; of equals the denser one.
[[nodiscard]] std::vector<std::vector<std::size_t>> clusters_of(
    const std::vector<Eigen::Vector3d>& points, double reach);

/// Per joint the mean of the largest group of sights that agree.
[[nodiscard]] Method largest_cluster();

}  // namespace chorus::bench::baselines

// Baselines that average views: all, the tracked ones, or the largest cluster of them.
#pragma once

#include <vector>

#include "fusion-server/fusion/fuse.h"
#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// Views of a joint that are closer than this belong together [m] (10 cm as in Lee 2022).
inline constexpr double kClusterReach = 0.1;

/// One of the product's methods, with its memory of one person.
[[nodiscard]] Method product(fusion::FusionConfig config);
[[nodiscard]] Method product(fusion::Method method);

/// The mean over the views that track a joint; if none does, over those that infer it.
[[nodiscard]] Method tracked_mean();

/// Groups of points linked by steps of at most `reach`, largest first; of equally large ones, the
/// denser first.
[[nodiscard]] std::vector<std::vector<std::size_t>> clusters_of(
    const std::vector<Eigen::Vector3d>& points, double reach);

/// For each joint, the mean of the largest group of joint views that agree.
[[nodiscard]] Method largest_cluster();

}  // namespace chorus::bench::baselines

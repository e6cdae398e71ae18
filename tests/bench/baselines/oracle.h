// Bounds: bodies that only somebody who knows the truth can make of one instant's views.
//
// `bound`: per joint, of all weighted means of the views' sightings (weights >= 0 that sum to one)
// the one nearest to the truth.  Selection, means, robust means, any weighting: no method whose
// joint is such a mean of one instant can be nearer, however good its weights.  Only one that does
// something else can: remember earlier instants, know the bones, take a bias off.  It is not
// reachable: the weights follow the truth anew at every joint and instant.
//
// `oracle-weights`: the weighted mean with weights 1 / e^2, where e is how far off each sighting
// truly is: what a method would give that predicts the size of every error perfectly, but not its
// direction.
#pragma once

#include <span>

#include "tests/bench/baselines/baseline.h"

namespace chorus::bench::baselines {

/// A body of a person's views and the truth.
using Told = Body (*)(const Person& person, const Body& exact);

[[nodiscard]] Body nearest_mean(const Person& person, const Body& exact);
[[nodiscard]] Body error_weighted_mean(const Person& person, const Body& exact);

/// The point nearest to `target` in the convex hull of `points`, to a fifth of a millimetre;
/// not finite without points.
[[nodiscard]] Eigen::Vector3d nearest_in_hull(std::span<const Eigen::Vector3d> points,
                                              const Eigen::Vector3d& target);

}  // namespace chorus::bench::baselines

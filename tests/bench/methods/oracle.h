// Bounds: bodies that only somebody who knows more than a tracker can make of one instant's views.
//
// `bound`: per joint the linear combination of the views' sightings of least mean square error,
// given the true mean square of each sighting's error at that instant and how the sensors' errors
// hang together (Gauss and Markov; for Gaussian errors the Cramer-Rao bound).  Reachable: it knows
// how large errors are on average, as a perfect error model would, but not which were made.  No
// method that combines one instant's sightings of a joint linearly does better on average; only one
// that does something else can: remember earlier instants, know the bones, take a bias off.
//
// `oracle-weights`: the weighted mean with weights 1 / e^2, where e is how far off each sighting
// truly is: what a method would give that predicts the size of every error perfectly, but not its
// direction.  Not reachable.
#pragma once

#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// How the errors of two sensors correlate which see the same joint.
struct SharedErrors {
  double joints = 0.0;  ///< Where both see the same side.
  double neck = 0.0;    ///< Of neck and chest.
  double twice = 0.0;   ///< Of it, what comes round twice as the view does once.
};

/// The views' joints must bring their true mean square errors (judge.h, confided()); the answer
/// states its covariance.  Sightings that bring none are left out.
[[nodiscard]] Body linear_bound(const Person& person, const SharedErrors& shared);

/// A body of a person's views and the truth.
using Told = Body (*)(const Person& person, const Body& exact);

[[nodiscard]] Body error_weighted_mean(const Person& person, const Body& exact);

}  // namespace chorus::bench::baselines

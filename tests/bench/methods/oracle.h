// Bounds: bodies made of one instant's views with knowledge that no tracker has.
//
// `bound`: for each joint, the linear combination of its views with the smallest mean square error,
// given the true mean square of each view's error at that instant and how the sensors' errors
// correlate (Gauss and Markov; for Gaussian errors the Cramer-Rao bound).  A method could reach
// this bound: it uses only how large errors are on average, as a perfect error model would, not the
// actual errors.  No method that combines one instant's views linearly is better on average; other
// methods can be, because they can remember earlier instants, know the bones or remove a bias.
//
// `oracle-weights`: the weighted mean with weights 1 / e^2, where e is the actual distance of each
// view from the truth: the result of a method that predicts the size of every error perfectly, but
// not its direction.  No method can reach it.
#pragma once

#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// Correlation of the errors of two sensors that see the same joint.
struct SharedErrors {
  double joints = 0.0;  ///< Where both see the same side.
  double neck = 0.0;    ///< The same for neck and chest.
  double twice = 0.0;   ///< Fraction that varies with twice the angle between the views.
};

/// Computes the body `bound` (see above) and states its covariance.  The views' joints must carry
/// their true mean square errors (judge.h, confided()); joint views without one are left out.
[[nodiscard]] Body linear_bound(const Person& person, const SharedErrors& shared);

/// Computes a body from a person's views and the truth.
using Told = Body (*)(const Person& person, const Body& exact);

[[nodiscard]] Body error_weighted_mean(const Person& person, const Body& exact);

}  // namespace chorus::bench::baselines

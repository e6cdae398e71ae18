// Whether stated errors of joints are true: compares stated covariances with true errors.
//
// Only joints that are reported with a covariance count; NaN if there are none.
#pragma once

#include "tests/judge/metrics.h"

namespace chorus::bench {

/// Which joints to consider.
struct Sighted {
  std::size_t least_views = 0;
  std::size_t most_views = 1000;
  enum class Motion { Any, Rest, Moving } motion = Motion::Any;  ///< How the true joint moves.
};

/// Normalised estimation error squared, mean per axis: 1 is consistent, above 1 is overconfident.
[[nodiscard]] double nees(const Answers& answers, const Sighted& which = {});

/// Fraction of true positions inside the stated 95 % ellipsoid.
[[nodiscard]] double ball95_share(const Answers& answers, const Sighted& which = {});

/// Ratio of the stated to the true root mean square error.
[[nodiscard]] double sharpness(const Answers& answers, const Sighted& which = {});

}  // namespace chorus::bench

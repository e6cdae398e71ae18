// Is what is stated about the error of a joint true?  Stated covariances beside true errors.
//
// Only joints whose answer states a covariance count; NaN when there are none.
#pragma once

#include "tests/judge/metrics.h"

namespace chorus::bench {

/// Which joints are asked about.
struct Sighted {
  std::size_t least_views = 0;
  std::size_t most_views = 1000;
  enum class Motion { Any, Rest, Moving } motion = Motion::Any;  ///< Of the true joint.
};

/// Normalised estimation error squared, mean per axis: 1 is honest, above 1 promises too much.
[[nodiscard]] double nees(const Answers& answers, const Sighted& which = {});

/// Share of the true places inside the stated 95 % ellipsoid.
[[nodiscard]] double ball95_share(const Answers& answers, const Sighted& which = {});

/// Stated over true root mean square error.
[[nodiscard]] double sharpness(const Answers& answers, const Sighted& which = {});

}  // namespace chorus::bench

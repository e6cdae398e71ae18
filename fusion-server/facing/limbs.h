// Finds limbs whose left and right a sensor has exchanged alone: only the arms, only the legs, or
// one pair, while the rest of the body is labelled correctly (Otto Fig. 5; docs/papers/sides.md,
// Limbs).
#pragma once

#include "fusion-server/facing/lateral.h"

namespace chorus::facing {

struct LimbLimits {
  bool mend = true;
  double apart = 0.15;  ///< Pairs closer together than this are not changed [m].
  double better = 0.3;  ///< Exchanging a pair must reduce its squared error to this fraction.

  bool operator==(const LimbLimits&) const = default;
};

/// To be called after each view's labels have been corrected as a whole.  Exchanges a pair back if
/// that fits two or more other views much better; a pair that only contradicts `held`, the recently
/// agreed spans, becomes Inferred.
void mend_limbs(Person& person, const Spans& held, const LimbLimits& limits);

}  // namespace chorus::facing

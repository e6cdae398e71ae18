// Finds single limbs whose left and right a sensor has exchanged: only the arms, only the legs, or
// one pair, while the rest of the body is labelled correctly (Otto Fig. 5; docs/papers/sides.md,
// Limbs).
#pragma once

#include "fusion-server/facing/lateral.h"

namespace chorus::facing {

struct LimbLimits {
  bool mend = true;
  double apart = 0.15;  ///< Pairs closer together than this are not changed [m].
  double better = 0.3;  ///< An exchanged pair must reduce the squared error to this share.

  bool operator==(const LimbLimits&) const = default;
};

/// Call it after each view's labels have been corrected as a whole.  Exchanges a pair back if that
/// fits two or more other views much better; a pair that only contradicts `held`, the recent
/// agreement, counts as guessed.
void mend_limbs(Person& person, const Spans& held, const LimbLimits& limits);

}  // namespace chorus::facing

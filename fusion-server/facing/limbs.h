// Finds limbs whose left and right a sensor has swapped separately: only the arms, only the legs,
// or one pair of joints, while the rest of the body is labelled correctly (Otto Fig. 5;
// docs/papers/sides.md, Limbs).
#pragma once

#include "fusion-server/facing/lateral.h"

namespace chorus::facing {

struct LimbLimits {
  bool mend = true;
  double apart = 0.15;  ///< A pair whose joints are closer together than this is not changed [m].
  /// Swapping a pair must reduce its squared error to at most this fraction.
  double better = 0.3;

  bool operator==(const LimbLimits&) const = default;
};

/// Call this after each view's labels have been corrected as a whole.  If two or more other views
/// show a pair of joints, the pair is swapped, together with the joints beyond it (such as hands),
/// if that fits the mean of these views much better.  If fewer do, a pair that clearly contradicts
/// `held`, the recently agreed spans, becomes Inferred.
void mend_limbs(Person& person, const Spans& held, const LimbLimits& limits);

}  // namespace chorus::facing

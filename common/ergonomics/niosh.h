// The revised NIOSH lifting equation (Waters, Putz-Anderson & Garg 1994): the recommended weight
// limit of a lift, and the lifting index.
#pragma once

#include "common/ergonomics/asked.h"

namespace chorus::ergonomics {

/// One end of a lift.  Metres, radians.
struct Lift {
  double horizontal = 0.25;  ///< H: from the middle of the ankles to the middle of the hands.
  double vertical = 0.75;    ///< V: of the hands above the floor.
  double distance = 0.25;    ///< D: vertical travel of the hands.
  double asymmetry = 0.0;    ///< A: of the load from the sagittal plane.
  double per_minute = 0.2;
  double hours = 1.0;
  Coupling coupling = Coupling::Good;
};

struct LiftLimit {
  double hm = 0, vm = 0, dm = 0, am = 0, fm = 0, cm = 0;  ///< The multipliers, 0 to 1.
  double weight_kg = 0;                                   ///< RWL; 0: nothing may be lifted so.
};

/// Out of the equation's range (H over 63 cm, V over 175 cm, A over 135 degrees, more than 8 h) a
/// multiplier is 0; NaN counts as out of range.
[[nodiscard]] LiftLimit lift_limit(const Lift& lift);

/// Load over limit; infinite if the limit is 0.
[[nodiscard]] double lifting_index(double load_kg, const LiftLimit& limit);

}  // namespace chorus::ergonomics

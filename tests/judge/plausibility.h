// Does the answered body behave as a body: limbs on their own side, bones of the right length, feet
// that stand?
//
// Metres and shares; NaN when there was nothing to measure.
#pragma once

#include "tests/judge/metrics.h"

namespace chorus::bench {

/// Share of pairs of limbs (arms: elbows to hands; legs: knees to feet) that fit the truth better
/// with left and right exchanged, although the body as a whole does not.  Only where the two are
/// truly 0.15 m apart or more.
[[nodiscard]] double limb_label_error_share(const Answers& answers);

/// How far a bone's mean length is from the true one, over the true one; mean over upper arms,
/// forearms, thighs and shanks.
[[nodiscard]] double bone_length_error(const Answers& answers);

/// How far an answered ankle wanders while the true one stands: root mean square over the floor
/// about its mean, over all stances of 0.2 s or more [m].
[[nodiscard]] double foot_slide(const Answers& answers);

/// Mean distance of the truth 50 ms later from the answer now: what an application sees that holds
/// the last pose [m].
[[nodiscard]] double held_error(const Answers& answers);

}  // namespace chorus::bench

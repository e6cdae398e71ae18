// Whether the reported body behaves like a body: limbs on the correct side, bones of the correct
// length, feet that stand still.
//
// In metres and fractions; NaN when there was nothing to measure.
#pragma once

#include "tests/judge/metrics.h"

namespace chorus::bench {

/// Fraction of pairs of limbs (arms: elbows to hands; legs: knees to feet) that fit the truth
/// better with left and right swapped.  A pair counts only where its joints are truly at least 0.15
/// m apart on average and the body as a whole is not swapped.
[[nodiscard]] double limb_label_error_share(const Answers& answers);

/// Error of a bone's mean length relative to the true one; averaged over upper arms, forearms,
/// thighs and shanks.
[[nodiscard]] double bone_length_error(const Answers& answers);

/// How far a reported ankle moves while the true one stands: horizontal rms deviation from its
/// mean, over all stances of 0.2 s or more [m].
[[nodiscard]] double foot_slide(const Answers& answers);

/// Mean distance between the reported body and the truth 50 ms later: the error of an application
/// that keeps the last pose [m].
[[nodiscard]] double held_error(const Answers& answers);

}  // namespace chorus::bench

// Baselines that trust one view at a time.
#pragma once

#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// How long another view must be better before the best skeleton switches to it.
inline constexpr Duration kHysteresis = std::chrono::milliseconds(300);

/// Fraction of tracked joints plus how squarely the body faces the sensor, each in [0, 1]; an
/// unknown facing counts as a side view.
[[nodiscard]] double skeleton_score(const SensorView& view);

/// A: the whole view with the highest score; switches after kHysteresis or when it is gone.
[[nodiscard]] Method best_skeleton();

/// B: the whole view with the most tracked joints; of equals the smallest sensor id.
[[nodiscard]] Method joint_counting();

/// C: the best skeleton, but a joint that it does not track comes from the best view that does.
[[nodiscard]] Method substitution();

}  // namespace chorus::bench::baselines

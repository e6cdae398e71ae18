// Baselines that trust one view at a time.
#pragma once

#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// How long another view must be the better one before the best skeleton changes hands.
inline constexpr Duration kHysteresis = std::chrono::milliseconds(300);

/// Share of tracked joints plus how squarely the body faces the sensor, each in [0, 1]; an unknown
/// facing counts as a side view.
[[nodiscard]] double skeleton_score(const SensorView& view);

/// A: the view of the highest score, whole; changes hands after kHysteresis or when it is gone.
[[nodiscard]] Method best_skeleton();

/// B: the view with the most tracked joints, whole; of equals the least sensor id.
[[nodiscard]] Method joint_counting();

/// C: the best skeleton, but a joint it does not track comes from the best view that tracks it.
[[nodiscard]] Method substitution();

}  // namespace chorus::bench::baselines

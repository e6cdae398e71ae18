// How good one view of a person is as a whole.
#pragma once

#include "fusion-server/flow/person.h"

namespace chorus::fusion {

[[nodiscard]] long tracked_joints(const SensorView& view);

/// Fraction of joints tracked plus how squarely the body faces the sensor, each in [0, 1]; an
/// unknown facing counts as a side view.
[[nodiscard]] double view_score(const SensorView& view);

}  // namespace chorus::fusion

// What is remembered of each sensor besides its frames: one value each, in one map.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "fusion-server/associate/plausible.h"
#include "fusion-server/core/clock_correction.h"
#include "fusion-server/core/frame_losses.h"
#include "fusion-server/core/hindsight.h"

namespace chorus::core {

/// A sensor's contribution to the fused bodies; averages over about a second, in [0, 1].
struct Share {
  double in_time = 0.0;     ///< Fraction of all joints that it contributed to.
  double afterwards = 0.0;  ///< The same including its late frames, as /frame?at= shows it.
  double awaited = 0.0;     ///< Fraction of instants that still waited for it when they were fused.
};

struct SensorMemory {
  associate::FrozenBodies frozen;
  FrameLosses losses;
  Share share;
  ClockCorrection clock;
  std::optional<Timestamp> displaced;  ///< When it last lost its place because it was moved.
};

using SensorMemories = std::map<SensorId, SensorMemory>;

/// Takes the contributions to a snapshot; `awaited`: the sensors for which it still waited.
void note_shares(const Snapshot& snapshot, const std::vector<SensorId>& awaited,
                 SensorMemories& sensors);
/// Takes the final contributions to an instant, when no later frame will improve it.
void note_settled(const Parts& parts, SensorMemories& sensors);

}  // namespace chorus::core

// How much later than the others a sensor stamps what it sees, as a walk showed it.
#pragma once

#include <map>

#include "common/base/duration.h"
#include "common/base/strong_id.h"

namespace chorus {

/// From exposure to stamp, beyond what the clock is off: a camera's exposure and transfer, a
/// tracker that smooths.  What all sensors have in common cannot be seen.
struct Latency {
  Duration found{0};     ///< Relative to the median of the sensors.
  Duration sigma{0};     ///< Standard deviation.
  bool applied = false;  ///< True if it is taken off the capture times; else it is only told.

  bool operator==(const Latency&) const = default;
  /// Added to the sensor's capture times.
  [[nodiscard]] Duration added() const { return applied ? -found : Duration{0}; }
};

using Latencies = std::map<SensorId, Latency>;

}  // namespace chorus

// By how much a sensor's clock is off, as a walk showed it, and while that holds.
#pragma once

#include <optional>

#include "common/base/duration.h"
#include "common/time/clock_estimate.h"

namespace chorus {

/// The correction of one sensor's clock, as found from the walk.
struct ClockOffset {
  Duration added{0};  ///< Common clock minus the sensor's: added to its capture times.
  Duration sigma{0};  ///< Standard deviation; zero for the sensor whose clock is the common one.
  /// The SensorFrame::clock_sigma of the capture times from which the offset was found.
  Duration stated = from_seconds(kUnknownClock);
  /// The shortest time from capture, by the sensor's own stamp, to receipt during the walk; none:
  /// not known.
  std::optional<Duration> least_age = {};
};

/// Whether a host whose capture times have this clock_sigma answers with its own time.
[[nodiscard]] constexpr bool exchanges_time(double clock_sigma) {
  return clock_sigma < 0.5 * kUnknownClock;
}

/// Whether the offset holds for capture times of this clock_sigma.  It does not if the host has
/// since begun or ceased to answer with its time, or if the host's own estimate is now the better
/// one.
[[nodiscard]] inline bool holds_for(const ClockOffset& clock, double clock_sigma) {
  return exchanges_time(clock_sigma) == exchanges_time(seconds(clock.stated)) &&
         clock_sigma > seconds(clock.sigma);
}

}  // namespace chorus

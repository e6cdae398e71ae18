// Moves one sensor's bodies to a common instant by linear interpolation (Otto 5.2.4).
//
// Positions are interpolated linearly, orientations by sign-aligned normalised LERP. A joint is
// interpolated only when both frames saw it; its state is the worse of the two.  Bodies are matched
// by id; a body that only one of the frames has is left out, as is one that would have moved faster
// than anybody can: its id went to somebody else between the two.  Nothing is ever extrapolated.
#pragma once

#include <optional>

#include "fusion-server/align/history.h"
#include "fusion-server/flow.h"

namespace chorus::align {

struct AlignConfig {
  /// Widest bracket that is interpolated, unless the sensor's own period is long
  /// (widest_gap).
  Duration max_gap = std::chrono::milliseconds(120);
  /// Age at which Pending turns into Lost, unless the sensor's recent delays say sooner
  /// (longest_wait).
  Duration patience = std::chrono::milliseconds(200);
  /// A sensor whose delay varies by more than this from frame to frame, and more than twice as much
  /// as is usual among the others, is waited for no longer than the others usually need, so that
  /// one bad link does not delay everybody's bodies.
  Duration unsteady = std::chrono::milliseconds(30);
  /// Where sensors are slow (cameras whose pictures take long), `max_gap` and `patience` grow with
  /// their periods and delays up to this.  If this is less than both, they never grow.
  Duration slowest = std::chrono::milliseconds(2000);
  double max_speed = 6.0;  ///< Of a body's core joints [m/s].

  bool operator==(const AlignConfig&) const = default;
};

/// The sensor's bodies at `instant`, as known at time `now` (both by the server's clock).
[[nodiscard]] AlignedSensor at(Timestamp instant, Timestamp now, const SensorId& sensor,
                               const History& history, const AlignConfig& config);

/// What kind of answer at() would give, without building the bodies.
[[nodiscard]] Basis basis_at(Timestamp instant, Timestamp now, const History& history,
                             const AlignConfig& config);

/// Widest bracket of this sensor that is interpolated: max_gap, or two of its periods.
[[nodiscard]] Duration widest_gap(const History& history, const AlignConfig& config);

/// How long after an instant this sensor's next frame arrives at the latest, judged by its recent
/// frames; none until enough frames with a time of arrival have come.
[[nodiscard]] std::optional<Duration> longest_wait(const History& history);

/// The median instead of the longest: one frame that the processor delayed does not change it.
[[nodiscard]] std::optional<Duration> usual_wait(const History& history);

}  // namespace chorus::align

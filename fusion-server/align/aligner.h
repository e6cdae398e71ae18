// Moves one sensor's bodies to a common instant by linear interpolation (Otto 5.2.4).
//
// Positions linearly, orientations by sign-aligned normalised LERP.  A joint is interpolated only
// when both ends saw it; its state is the worse of the two.  Bodies are matched by id; a body that
// only one end has is left out.  Nothing is ever extrapolated.
#pragma once

#include <optional>

#include "fusion-server/align/history.h"
#include "fusion-server/flow.h"

namespace chorus::align {

struct AlignConfig {
  /// Widest bracket that is interpolated across, unless the sensor's own period is long
  /// (widest_gap).
  Duration max_gap = std::chrono::milliseconds(120);
  /// Age at which Pending turns into Lost, unless the sensor's own habit says sooner
  /// (longest_wait).
  Duration patience = std::chrono::milliseconds(200);
  /// A sensor whose delay varies by more than this from frame to frame, and by more than twice what
  /// is usual among the others, is waited for no longer than the others usually need, so that one
  /// bad link does not make everybody's bodies old.
  Duration unsteady = std::chrono::milliseconds(30);
  /// Where sensors are slow (cameras whose pictures take long), `max_gap` and `patience` grow with
  /// their periods and delays, up to this.  Less than both: they never grow.
  Duration slowest = std::chrono::milliseconds(2000);

  bool operator==(const AlignConfig&) const = default;
};

/// The sensor's bodies at `instant`, as known `now` (both by the server's clock).
[[nodiscard]] AlignedSensor at(Timestamp instant, Timestamp now, const SensorId& sensor,
                               const History& history, const AlignConfig& config);

/// How `at` would answer, without building the bodies.
[[nodiscard]] Basis basis_at(Timestamp instant, Timestamp now, const History& history,
                             const AlignConfig& config);

/// Widest bracket of this sensor that is interpolated across: max_gap, or two of its periods.
[[nodiscard]] Duration widest_gap(const History& history, const AlignConfig& config);

/// How long after an instant this sensor's next frame comes at the latest, judged by its recent
/// frames; none before enough frames with a time of arrival have come.
[[nodiscard]] std::optional<Duration> longest_wait(const History& history);

/// The same by the median: a single frame that the processor delayed does not count.
[[nodiscard]] std::optional<Duration> usual_wait(const History& history);

}  // namespace chorus::align

// Moves one sensor's bodies to a common instant by linear interpolation (Otto 5.2.4).
//
// Positions linearly, orientations by sign-aligned normalised LERP.  A joint is interpolated only
// when both ends saw it; its state is the worse of the two.  Bodies are matched by id; a body
// present at one end only is lost.  Nothing is ever extrapolated.
#pragma once

#include <optional>

#include "fusion-server/align/history.h"
#include "fusion-server/flow.h"

namespace chorus::align {

struct AlignConfig {
  Duration max_gap =
      std::chrono::milliseconds(120);  ///< Widest bracket that is interpolated across.
  /// Age at which Pending turns into Lost, unless the sensor's own habit says sooner (usual_wait).
  Duration patience = std::chrono::milliseconds(200);
  /// A sensor whose frames are late by more or less than this from one to the next is waited for
  /// no longer than the others need: one bad link does not make everybody's bodies old.
  Duration unsteady = std::chrono::milliseconds(30);

  bool operator==(const AlignConfig&) const = default;
};

/// The sensor's bodies at `instant`, as known `now` (both by the server's clock).
[[nodiscard]] AlignedSensor at(Timestamp instant, Timestamp now, const SensorId& sensor,
                               const History& history, const AlignConfig& config);

/// How `at` would answer, without building the bodies.
[[nodiscard]] Basis basis_at(Timestamp instant, Timestamp now, const History& history,
                             const AlignConfig& config);

/// How long after an instant this sensor's next frame comes at the latest, by its recent gaps and
/// arrival delays; none before there are enough frames with a time of arrival.
[[nodiscard]] std::optional<Duration> usual_wait(const History& history);

/// One body between two captures; s in [0, 1].  Exposed for registration and tests.
[[nodiscard]] Skeleton<SensorSpace> interpolate(const Skeleton<SensorSpace>& a,
                                                const Skeleton<SensorSpace>& b, double s);

}  // namespace chorus::align

// Moves one sensor's bodies to a common instant by linear interpolation (Otto 5.2.4).
//
// Positions are interpolated linearly, orientations by sign-aligned normalised LERP. A joint is
// interpolated only when both frames saw it; its state is the worse of the two. Bodies are matched
// by place and id (same_body.h). A body that only one of the two frames has is left out. So is one
// that would have moved faster than anybody can. Nothing is extrapolated.
#pragma once

#include <optional>

#include "fusion-server/align/history.h"
#include "fusion-server/flow/aligned_sensor.h"

namespace chorus::align {

struct AlignConfig {
  /// Widest gap between two frames that is interpolated; it is wider for a sensor with a long
  /// period (widest_gap).
  Duration max_gap = std::chrono::milliseconds(120);
  /// While the sensor has no later frame, an instant is Pending for at most this long and then
  /// Lost. It is Lost earlier if the sensor's recent frames arrived sooner (longest_wait), or if
  /// the gap is already too wide (widest_gap).
  Duration patience = std::chrono::milliseconds(200);
  /// A sensor is unsteady if its delay varies from frame to frame by more than this, by more than
  /// twice the median over the sensors, and by more than half its period.  Such a sensor is waited
  /// for no longer than the others usually need, so that one bad link does not delay everybody's
  /// bodies.
  Duration unsteady = std::chrono::milliseconds(30);
  /// How far `max_gap` may grow for a sensor with a long period, and `patience` where most sensors
  /// are slow (cameras whose pictures take long).  Whichever of the two is larger than this does
  /// not grow.
  Duration slowest = std::chrono::milliseconds(2000);
  /// A body whose core joints move faster than this on average is left out [m/s].
  double max_speed = 6.0;

  bool operator==(const AlignConfig&) const = default;
};

/// The sensor's bodies at `instant`, as far as they are known at time `now` (both by the server's
/// clock).
[[nodiscard]] AlignedSensor at(Timestamp instant, Timestamp now, const SensorId& sensor,
                               const History& history, const AlignConfig& config);

/// The Basis that at() would return, without building the bodies.
[[nodiscard]] Basis basis_at(Timestamp instant, Timestamp now, const History& history,
                             const AlignConfig& config);

/// Widest gap between two frames of this sensor that is interpolated: max_gap, or two of its
/// periods if that is longer, but then at most `slowest`.
[[nodiscard]] Duration widest_gap(const History& history, const AlignConfig& config);

/// The longest time that an instant waits for this sensor's next frame, judged by the recent
/// frames, plus 15 ms; none until there are enough frames with a time of receipt.
[[nodiscard]] std::optional<Duration> longest_wait(const History& history);

/// Like longest_wait(), but for the median of the recent frames instead of the longest wait; a
/// single frame that was delayed on a busy processor does not change it.
[[nodiscard]] std::optional<Duration> usual_wait(const History& history);

}  // namespace chorus::align

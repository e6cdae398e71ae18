// One sensor's recent frames, in capture order, without duplicates (Otto 5.2.4).
//
// A late frame (fetched after a stream left it out) is inserted at its place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "fusion-server/flow.h"

namespace chorus::align {

enum class PushVerdict {
  Added,
  Duplicate,  ///< A frame of this capture time is already there (polled faster than captured).
  Late,       ///< Earlier in the sensor's sequence than the newest; inserted at its place.
  Backwards,  ///< Later in the sequence, but captured before the newest one; refused.
  Future,     ///< Captured implausibly far after it was received; refused.
  Restarted,  ///< A long step back: the sensor's clock was set or the device restarted; history
              ///< cleared.
};

struct HistoryLimits {
  std::size_t max_frames = 256;
  Duration max_age = std::chrono::seconds(5);
  /// A frame is refused if captured - received exceeds this; one without `received` is accepted.
  Duration max_future = std::chrono::seconds(2);
  /// A step back longer than this is a restart.
  Duration restart_step = std::chrono::milliseconds(1500);
};

/// How a sensor's recent frames have arrived.
struct Habit {
  /// Time from an instant until a frame captured at it or later arrived, for instants just after a
  /// capture, which wait longest.  Frames that arrived after later ones do not count.
  Duration longest_wait{0};
  Duration usual_wait{0};   ///< Median of the same.
  Duration least_delay{0};  ///< From capture to receipt, the shortest.
  Duration late_delay{0};   ///< From capture to receipt, 90th percentile.

  [[nodiscard]] Duration spread() const { return late_delay - least_delay; }
};

class History {
 public:
  explicit History(HistoryLimits limits = {}) : limits_(limits) {}

  /// When two bodies of a frame have the same id, the first is kept.
  PushVerdict push(SensorFrame frame);

  [[nodiscard]] const std::deque<SensorFrame>& frames() const noexcept { return frames_; }
  [[nodiscard]] std::optional<Timestamp> newest() const;
  /// Nothing until enough frames with a time of receipt have come.  Late frames do not count.
  [[nodiscard]] const std::optional<Habit>& habit() const noexcept { return habit_; }
  /// Median time from capture to capture of the recent frames; nothing until there are enough.
  [[nodiscard]] const std::optional<Duration>& period() const noexcept { return period_; }
  /// The sensor sees directions only: the newest frame with bodies has none but ray bodies.
  [[nodiscard]] bool rays_only() const noexcept { return rays_only_; }

 private:
  HistoryLimits limits_;
  std::deque<SensorFrame> frames_;
  std::optional<Habit> habit_;
  std::optional<Duration> period_;
  bool rays_only_ = false;
};

}  // namespace chorus::align

// One sensor's recent frames, in capture order, each exactly once (Otto 5.2.4).
//
// A late frame (fetched after a stream left it out) is put in its place among the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "fusion-server/flow.h"

namespace chorus::align {

enum class PushVerdict {
  Added,
  Duplicate,  ///< A frame of this capture time is already there (polling faster than the sensor).
  Late,       ///< Earlier in the sensor's sequence than the newest; put in its place.
  Backwards,  ///< Later in the sequence, but captured before the newest one; refused.
  Future,     ///< Captured implausibly far after it was received; refused.
  Restarted,  ///< A long step back: the sensor's clock was set or the device restarted; history
              ///< cleared.
};

struct HistoryLimits {
  std::size_t max_frames = 256;
  Duration max_age = std::chrono::seconds(5);
  /// captured - received beyond which a frame is refused; a frame without `received` is not judged.
  Duration max_future = std::chrono::seconds(2);
  /// A step back longer than this is a restart.
  Duration restart_step = std::chrono::milliseconds(1500);
};

/// How a sensor's frames have arrived lately.
struct Habit {
  /// After an instant, until a frame captured at it or later was there: for instants just behind a
  /// capture, which wait longest.  Frames that came after later ones tell nothing.
  Duration longest_wait{0};
  Duration usual_wait{0};   ///< Median.
  Duration least_delay{0};  ///< From capture to receipt.
  Duration late_delay{0};   ///< Of ten frames one comes later.

  [[nodiscard]] Duration spread() const { return late_delay - least_delay; }
};

class History {
 public:
  explicit History(HistoryLimits limits = {}) : limits_(limits) {}

  /// When two bodies of a frame have the same id, the first is kept.
  PushVerdict push(SensorFrame frame);

  [[nodiscard]] const std::deque<SensorFrame>& frames() const noexcept { return frames_; }
  [[nodiscard]] std::optional<Timestamp> newest() const;
  /// None before enough frames with a time of receipt.  Late frames do not count.
  [[nodiscard]] const std::optional<Habit>& habit() const noexcept { return habit_; }
  /// From capture to capture, by the median of the recent ones; none before enough of them.
  [[nodiscard]] const std::optional<Duration>& period() const noexcept { return period_; }
  /// It sees directions only: all bodies of the newest frame that shows any are rays alone.
  [[nodiscard]] bool rays_only() const noexcept { return rays_only_; }

 private:
  HistoryLimits limits_;
  std::deque<SensorFrame> frames_;
  std::optional<Habit> habit_;
  std::optional<Duration> period_;
  bool rays_only_ = false;
};

}  // namespace chorus::align

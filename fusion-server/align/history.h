// One sensor's recent frames, in capture order, without duplicates (Otto 5.2.4).
//
// A late frame (fetched after a stream had left it out) is inserted at its place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"

namespace chorus::align {

enum class PushVerdict {
  Added,
  Duplicate,  ///< There already is a frame with this capture time (polled faster than captured).
  Late,       ///< Its sequence is lower than the newest frame's; inserted at its place.
  Stale,      ///< Like Late, but too old to be of use; refused.
  Backwards,  ///< Its sequence is not lower, but it was captured before the newest frame; refused.
  Future,     ///< Captured implausibly long after it was received; refused.
  /// The last of `steps_to_restart` frames in a row that would have been refused as Stale or
  /// Backwards: the sensor's clock was set back, its device restarted, or the newest frame was from
  /// the future.  The history was cleared.
  Restarted,
};

struct HistoryLimits {
  std::size_t max_frames = 256;
  Duration max_age = std::chrono::seconds(5);
  /// A frame is refused if captured - received exceeds this; a frame without `received` is
  /// accepted.
  Duration max_future = std::chrono::seconds(2);
  /// A late frame that was captured longer than this before the newest one is Stale.
  Duration latest = std::chrono::milliseconds(1500);
  /// The history restarts with the last of this many frames in a row that would be refused as Stale
  /// or Backwards; frames that were received at the same time count as one.
  int steps_to_restart = 3;
};

/// How a sensor's recent frames arrived.
struct Habit {
  /// An instant just after a capture waits longest: until the next frame arrives.  This is the
  /// longest such wait among the recent frames.  Frames that arrived after later ones do not count.
  Duration longest_wait{0};
  Duration usual_wait{0};   ///< The median time that such instants had to wait.
  Duration least_delay{0};  ///< The shortest time from capture to receipt.
  Duration late_delay{0};   ///< The time from capture to receipt, 90th percentile.

  [[nodiscard]] Duration spread() const { return late_delay - least_delay; }
};

class History {
 public:
  explicit History(HistoryLimits limits = {}) : limits_(limits) {}

  /// Adds a frame.  If two bodies of the frame have the same id, the first one is kept.
  PushVerdict push(SensorFrame frame);

  /// Moves all capture times by `by`, because the sensor's clock turned out to be off by another
  /// amount.
  void move_in_time(Duration by);

  [[nodiscard]] const std::deque<SensorFrame>& frames() const noexcept { return frames_; }
  [[nodiscard]] std::optional<Timestamp> newest() const;
  /// None until enough frames with a time of receipt have come.  Late frames do not count.
  [[nodiscard]] const std::optional<Habit>& habit() const noexcept { return habit_; }
  /// Median time from one capture to the next, of the recent frames; none until there are enough.
  [[nodiscard]] const std::optional<Duration>& period() const noexcept { return period_; }
  /// True if the sensor sees directions only: the last frame with bodies had ray bodies only.
  [[nodiscard]] bool rays_only() const noexcept { return rays_only_; }

 private:
  [[nodiscard]] PushVerdict verdict_on(const SensorFrame& frame) const;

  HistoryLimits limits_;
  std::deque<SensorFrame> frames_;
  int steps_back_ = 0;   ///< Number of frames in a row refused as Stale or Backwards.
  Timestamp last_step_;  ///< When the last of these was received.
  std::optional<Habit> habit_;
  std::optional<Duration> period_;
  bool rays_only_ = false;
};

}  // namespace chorus::align

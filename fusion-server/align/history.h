// One sensor's recent frames, in capture order, each exactly once (Otto 5.2.4).
//
// A late one (fetched after a stream had left it out) takes its place among the others.
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
  Late,       ///< An earlier one of the sensor's sequence, and put in its place.
  Backwards,  ///< A later one of the sequence, captured before the newest one; refused.
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

/// How a sensor's frames have come lately.
struct Habit {
  Duration gap{0};          ///< Widest between two captures.
  Duration least_delay{0};  ///< From capture to receipt.
  Duration most_delay{0};
};

class History {
 public:
  explicit History(HistoryLimits limits = {}) : limits_(limits) {}

  /// Of two bodies with one id in the frame the first is kept.
  PushVerdict push(SensorFrame frame);

  [[nodiscard]] const std::deque<SensorFrame>& frames() const noexcept { return frames_; }
  [[nodiscard]] std::optional<Timestamp> newest() const;
  /// None before there are enough frames with a time of receipt.  Late ones tell nothing of it.
  [[nodiscard]] const std::optional<Habit>& habit() const noexcept { return habit_; }

 private:
  HistoryLimits limits_;
  std::deque<SensorFrame> frames_;
  std::optional<Habit> habit_;
};

}  // namespace chorus::align

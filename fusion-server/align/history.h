// One sensor's recent frames, in capture order, each exactly once (Otto 5.2.4).
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
  Backwards,  ///< Captured before the newest one; refused, counted, never reordered.
  Future,     ///< Captured implausibly far after it was received; refused.
  Restarted,  ///< A long step back: the sensor's clock was set or the device restarted; history
              ///< cleared.
};

struct HistoryLimits {
  std::size_t max_frames = 256;
  Duration max_age = std::chrono::seconds(5);
  /// captured - received beyond which a frame is refused; a frame without `received` is not judged.
  Duration max_future = std::chrono::seconds(2);
  Duration restart_step = std::chrono::seconds(1);  ///< A step back longer than this is a restart.
};

class History {
 public:
  explicit History(HistoryLimits limits = {}) : limits_(limits) {}

  /// Of two bodies with one id in the frame the first is kept.
  PushVerdict push(SensorFrame frame);

  [[nodiscard]] const std::deque<SensorFrame>& frames() const noexcept { return frames_; }
  [[nodiscard]] std::optional<Timestamp> newest() const;

 private:
  HistoryLimits limits_;
  std::deque<SensorFrame> frames_;
};

}  // namespace chorus::align

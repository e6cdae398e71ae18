// What became of a sensor's frames, and why some were refused.
#pragma once

#include <string>
#include <string_view>

#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"
#include "fusion-server/align/history.h"
#include "fusion-server/status/sensor_status.h"

namespace chorus::core {

class FrameLosses {
 public:
  /// Counts what the history made of the sensor's frame; true if it took it.
  bool count(const SensorFrame& frame, align::PushVerdict verdict);
  /// The frame, or a body of it, was refused for this reason, which must live as long as the
  /// program.
  void refuse(const SensorFrame& frame, std::string_view why);

  [[nodiscard]] const FrameFates& counts() const noexcept { return counts_; }
  /// Why something was refused in the last few seconds; empty: nothing was.
  [[nodiscard]] std::string complaint(Timestamp now) const;

 private:
  FrameFates counts_;
  Timestamp last_;  ///< When the last frame was received that was refused, or lost a body.
  std::string_view why_;
};

}  // namespace chorus::core

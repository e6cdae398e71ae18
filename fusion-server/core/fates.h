// What became of each sensor's frames, and why some were refused.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "common/base/strong_id.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"
#include "fusion-server/align/history.h"
#include "fusion-server/status/sensor_status.h"

namespace chorus::core {

class Fates {
 public:
  /// Counts what the history made of the frame; true if it took it.
  bool count(const SensorFrame& frame, align::PushVerdict verdict);
  /// The frame, or a body of it, was refused for this reason, which must live as long as the
  /// program.
  void refuse(const SensorFrame& frame, std::string_view why);
  void keep(const std::set<SensorId>& sensors);

  [[nodiscard]] FrameFates of(const SensorId& sensor) const;
  /// Why something from this sensor was refused in the last few seconds; empty: nothing was.
  [[nodiscard]] std::string complaint(const SensorId& sensor, Timestamp now) const;

 private:
  struct Refusals {
    FrameFates fates;
    Timestamp last;  ///< When the last frame was received that was refused, or lost a body.
    std::string_view why;
  };

  std::map<SensorId, Refusals> refused_;
};

}  // namespace chorus::core

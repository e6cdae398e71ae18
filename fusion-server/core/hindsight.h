// Instants that were answered without a sensor, for a second answer when its frames have come.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/pipeline/pipeline.h"

namespace chorus::core {

/// Of all joints of a snapshot, those that each of its sensors contributed to [0, 1]; empty without
/// bodies.
using Parts = std::map<SensorId, double>;
[[nodiscard]] Parts parts_of(const Snapshot& snapshot);

/// An instant as it was answered, and what the answer stood on.
struct Answered {
  Tick tick;
  pipeline::Memory before;        ///< What the instants before had left.
  std::vector<SensorId> without;  ///< Sensors with a place that had nothing to say in time.
  Parts parts;
};

class Hindsight {
 public:
  explicit Hindsight(Duration delay) : delay_(delay) {}

  /// Complete ones need not be told.
  void remember(Answered answered);
  /// The oldest instant that is so long ago that late frames must have come by now.
  [[nodiscard]] std::optional<Answered> due(Timestamp now);
  void forget() { waiting_.clear(); }

 private:
  Duration delay_;
  std::deque<Answered> waiting_;
};

/// What a sensor has to do with the fused bodies, each averaged over about a second [0, 1].
struct Share {
  double in_time = 0.0;     ///< Of all joints, those that it contributed to.
  double afterwards = 0.0;  ///< The same with its late frames, as /frame?at= has it.
  double awaited = 0.0;     ///< Of all instants, those whose answer waited for it to the last.
};

/// Shares of all sensors, instant by instant.
class Shares {
 public:
  void answered(const Snapshot& snapshot, const std::vector<SensorId>& awaited);
  /// No better answer than this will follow.
  void settled(const Parts& parts);
  [[nodiscard]] Share of(const SensorId& sensor) const;

 private:
  std::map<SensorId, Share> shares_;
};

}  // namespace chorus::core

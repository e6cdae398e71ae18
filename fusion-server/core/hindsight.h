// Instants that were answered without a sensor, kept for a second answer once its frames have come.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/pipeline/pipeline.h"

namespace chorus::core {

/// For each sensor of a snapshot, the share of all joints that it contributed to [0, 1]; empty
/// without bodies.
using Parts = std::map<SensorId, double>;
[[nodiscard]] Parts parts_of(const Snapshot& snapshot);

/// An instant as it was answered, with what the answer was based on.
struct Answered {
  Tick tick;
  pipeline::Memory before;        ///< What earlier instants had left.
  std::vector<SensorId> without;  ///< Sensors with a place whose frames did not arrive in time.
  Parts parts;
  Duration extension{0};  ///< How much longer than usual it may have waited.
};

class Hindsight {
 public:
  explicit Hindsight(Duration delay) : delay_(delay) {}

  /// Complete instants need not be added.
  void remember(Answered answered);
  /// The oldest instant old enough for late frames to have arrived by now.
  [[nodiscard]] std::optional<Answered> due(Timestamp now);
  void forget() { waiting_.clear(); }

 private:
  Duration delay_;
  std::deque<Answered> waiting_;
};

/// A sensor's part in the fused bodies, each averaged over about a second [0, 1].
struct Share {
  double in_time = 0.0;     ///< Share of all joints that it contributed to.
  double afterwards = 0.0;  ///< The same with its late frames, as /frame?at= has it.
  double awaited = 0.0;     ///< Share of all instants whose answer waited for it to the last.
};

/// Shares of all sensors, updated instant by instant.
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

// Keeps instants that were fused without some sensor, to fuse them again with its late frames.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/pipeline/pipeline.h"

namespace chorus::core {

/// For each sensor of a snapshot, the fraction of the seen joints that it contributed to, in [0,
/// 1]; empty if no sensor contributed to any joint.
using Parts = std::map<SensorId, double>;
[[nodiscard]] Parts parts_of(const Snapshot& snapshot);

/// An instant that was fused, with what is needed to fuse it again.
struct Answered {
  Tick tick;
  pipeline::Memory before;        ///< The memory before this instant.
  std::vector<SensorId> without;  ///< Registered sensors whose frames did not arrive in time.
  Parts parts;
  Duration extension{0};  ///< How much longer than usual the instant may have waited.
};

class Hindsight {
 public:
  explicit Hindsight(Duration delay) : delay_(delay) {}

  /// Instants that were fused with all sensors are ignored.
  void remember(Answered answered);
  /// Removes and returns the oldest instant if its late frames must have arrived by now.
  [[nodiscard]] std::optional<Answered> due(Timestamp now);
  void forget() { waiting_.clear(); }

 private:
  Duration delay_;
  std::deque<Answered> waiting_;
};

/// A sensor's contribution to the fused bodies; averages over about a second, in [0, 1].
struct Share {
  double in_time = 0.0;     ///< Fraction of all joints that it contributed to.
  double afterwards = 0.0;  ///< The same including its late frames, as /frame?at= shows it.
  double awaited = 0.0;     ///< Fraction of instants that still waited for it when they were fused.
};

/// The shares of all sensors, updated at each instant.
class Shares {
 public:
  void answered(const Snapshot& snapshot, const std::vector<SensorId>& awaited);
  /// Takes the final contributions of an instant, when no later frame will improve it.
  void settled(const Parts& parts);
  [[nodiscard]] Share of(const SensorId& sensor) const;
  void keep(const std::set<SensorId>& sensors);  ///< Forgets all other sensors.

 private:
  std::map<SensorId, Share> shares_;
};

}  // namespace chorus::core

// Keeps instants that were fused without some sensor, to fuse them again with its late frames.
#pragma once

#include <deque>
#include <map>
#include <optional>
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
  std::vector<PersonId> people;  ///< Who was published; an answer without them is not given.
  Duration extension{0};         ///< How much longer than usual the instant may have waited.
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

}  // namespace chorus::core

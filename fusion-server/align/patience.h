// How long an instant waits for each sensor, so that one bad link cannot delay everybody.
#pragma once

#include <map>

#include "fusion-server/align/aligner.h"

namespace chorus::align {

class Patience {
 public:
  /// From the habits of all sensors that take part.
  Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config);

  /// `config` with the patience for this sensor: all of it, or what the others usually need if it
  /// is unsteady compared with the others (on a busy machine the delays of all of them vary, and
  /// none is to blame).
  [[nodiscard]] AlignConfig of(const History& history) const;

 private:
  AlignConfig config_;
  Duration common_;  ///< The median of what the sensors usually need.
  Duration steady_;  ///< The widest spread that is not unsteady.
};

}  // namespace chorus::align

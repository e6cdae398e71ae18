// How long an instant waits for each sensor: long enough where they are slow, and never so that one
// bad link delays everybody.
#pragma once

#include <map>
#include <vector>

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

  /// How much longer than `config.patience` an instant may wait, because most of the sensors are
  /// slow.
  [[nodiscard]] Duration extension() const { return patience_ - config_.patience; }

 private:
  AlignConfig config_;
  Duration patience_;        ///< With steady sensors.
  Duration common_;          ///< The middle of what the sensors usually need.
  Duration steady_;          ///< The widest spread that is not unsteady.
  bool all_needed_ = false;  ///< There is no body without each of them.
};

}  // namespace chorus::align

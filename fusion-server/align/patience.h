// How long an instant waits for each sensor: long where most sensors are slow, but never so long
// that one bad link delays everybody.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/align/aligner.h"

namespace chorus::align {

class Patience {
 public:
  /// From the habits of all sensors that take part.
  Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config);

  /// `config` with the patience for this sensor: the full patience, or what the others usually need
  /// if this one is unsteady compared with them (on a busy machine the delays of all vary, and none
  /// is to blame).
  [[nodiscard]] AlignConfig of(const History& history) const;

  /// How much longer than `config.patience` an instant may wait, because most of the sensors are
  /// slow.
  [[nodiscard]] Duration extension() const { return patience_ - config_.patience; }

 private:
  AlignConfig config_;
  Duration patience_;        ///< For steady sensors.
  Duration common_;          ///< The median of what the sensors usually need.
  Duration steady_;          ///< A sensor with a wider spread is unsteady.
  bool all_needed_ = false;  ///< Without all of them there is no body.
};

}  // namespace chorus::align

// How long an instant waits for each sensor: long if most sensors are slow, but not because a
// single link is bad.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/align/aligner.h"

namespace chorus::align {

class Patience {
 public:
  /// `histories`: of all sensors that take part.
  Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config);

  /// `config` with the patience for this sensor, normally the full patience.  A sensor that is
  /// unsteady compared with the others gets only what the others usually need.  (On a busy machine
  /// the delays of all sensors vary, and none is unsteady.)  If one or two cameras without depth
  /// are the only sensors, they get the full patience, because a body needs each of them.
  [[nodiscard]] AlignConfig of(const History& history) const;

  /// How much longer than `config.patience` an instant may wait because most of the sensors are
  /// slow.
  [[nodiscard]] Duration extension() const { return patience_ - config_.patience; }

 private:
  AlignConfig config_;
  Duration patience_;        ///< The patience for steady sensors.
  Duration common_;          ///< How long an instant usually waits for a sensor: the median over
                             ///< the sensors.
  Duration steady_;          ///< A sensor with a wider spread is unsteady.
  bool all_needed_ = false;  ///< True if there are at most two sensors, and both show rays only.
};

}  // namespace chorus::align

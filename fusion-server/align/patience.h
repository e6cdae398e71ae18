// How long an instant waits for each sensor, so that one bad link cannot spend everybody's time.
#pragma once

#include <map>

#include "fusion-server/align/aligner.h"

namespace chorus::align {

class Patience {
 public:
  /// From the habits of all; `histories` are of the sensors that take part.
  Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config);

  /// `config` with the patience this sensor deserves: what it usually needs when it is steady, and
  /// otherwise at most what the others usually need.
  [[nodiscard]] AlignConfig of(const History& history) const;

 private:
  AlignConfig config_;
  Duration common_;  ///< What the middle one of the sensors usually needs.
};

}  // namespace chorus::align

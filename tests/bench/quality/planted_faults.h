// Faults as workshops have them, planted into a simulated recording, and what a verdict has to say.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/quality/simulated_day.h"

namespace chorus::bench {

struct PlantedFault {
  std::string name;
  /// Words of one finding that names it.
  std::vector<std::string> named_by;
  /// Changes the setting of a healthy day.
  std::function<void(DaySetting&)> plant;
};

[[nodiscard]] std::vector<PlantedFault> planted_faults();

}  // namespace chorus::bench

// What was measured of sensors, for people and as JSON, and the two profiles made from it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/characteristics/kind.h"

namespace chorus::ctl {

/// All that `chorus characterise` knows in the end.
struct SensorReport {
  characteristics::Measured measured;
  characteristics::Kind kind;
  std::vector<std::string> notes;  ///< What could not be measured, and why.
  std::string source;              ///< The recordings, for the heads of the profiles.
};

[[nodiscard]] std::string characterise_text(const SensorReport& report);
/// Millimetres and degrees, as the names of the members say.
[[nodiscard]] nlohmann::json characterise_json(const SensorReport& report);

/// The keys of the fusion server's configuration about which the measurements say something, with
/// comments; every other key keeps its default.
[[nodiscard]] std::string fusion_profile(const SensorReport& report);

/// The same for `chorus-sensor` with the device `simulated`.
[[nodiscard]] std::string simulation_profile(const SensorReport& report);

}  // namespace chorus::ctl

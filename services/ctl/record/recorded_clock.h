// What a recording keeps of a sensor's clock.
#pragma once

#include <nlohmann/json.hpp>

#include "common/record/cell_writer.h"

namespace chorus::ctl {

/// The clock model that this resource of /sensors/ reports, exact to the microsecond, without the
/// correction found from a walk, which is recorded with the registration.
[[nodiscard]] record::ClockModel clock_of(const nlohmann::json& sensor);

}  // namespace chorus::ctl

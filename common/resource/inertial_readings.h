// Reads what is below "readings" in /orientations alone, for messages that are no whole document.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"

namespace chorus::resource {

/// By the sensor's name, as read_orientations() does.  A reading without capturedNanoseconds was
/// taken at `captured`.
[[nodiscard]] Result<std::vector<inertial::InertialReading>> read_readings(
    const nlohmann::json& readings, Timestamp captured);

}  // namespace chorus::resource

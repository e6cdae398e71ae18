// Writes and reads the message chorus.FloorPlane.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::record {

[[nodiscard]] std::string floor_json(const FloorPlane& floor);
[[nodiscard]] Result<FloorPlane> read_floor_json(std::string_view text);

}  // namespace chorus::record

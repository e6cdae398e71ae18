// The device `positioner`: a person in an inertial suit before cameras, placed in the world.
#pragma once

#include <memory>

#include "services/sensor/device/device_kinds.h"

namespace chorus::positioner {

/// Reads device.positioner; checks the files, and makes the cameras.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_positioner(
    ConfigReader& section, const sensor_service::DeviceContext& context);

}  // namespace chorus::positioner

// The device `suit`: an inertial suit as a sensor, from its program's network stream or a file.
#pragma once

#include <memory>

#include "services/sensor/device/device_kinds.h"

namespace chorus::suit {

/// Reads device.suit; a file is read whole, a socket is opened when the device runs.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_suit(
    ConfigReader& section, const sensor_service::DeviceContext& context);

}  // namespace chorus::suit

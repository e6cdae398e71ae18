// The device `glove`: a hand whose pose a glove tells, placed by one calibrated camera.
#pragma once

#include <memory>

#include "services/sensor/device/device_kinds.h"

namespace chorus::glove {

/// Reads device.glove and its files, and adds `/hands` to the context's router.  A missing webcam
/// is not an error, because it may appear later.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_glove(
    ConfigReader& section, const sensor_service::DeviceContext& context);

}  // namespace chorus::glove

// The runner that comes with Chorus: where it is, and whether it can run.
#pragma once

#include "common/base/result.h"
#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::camera {

/// What is started: device.camera.runner, or the runner that comes with Chorus; with the model.
/// NotFound when the latter is nowhere.
[[nodiscard]] Result<std::vector<std::string>> runner_command(const CameraSettings& settings);

/// Asks the runner that comes with Chorus whether it has what it needs; others are not asked.
[[nodiscard]] Result<void> check_runner(const CameraSettings& settings);

}  // namespace chorus::camera

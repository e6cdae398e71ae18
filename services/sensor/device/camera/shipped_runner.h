// The runner that ships with Chorus: where it is, and whether it can run.
#pragma once

#include "common/base/result.h"
#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::camera {

/// The command to start: device.camera.runner, or the runner that ships with Chorus; with the
/// model. NotFound when the latter does not exist.
[[nodiscard]] Result<std::vector<std::string>> runner_command(const CameraSettings& settings);

/// Asks the shipped runner whether it has everything it needs; does not ask other runners.
[[nodiscard]] Result<void> check_runner(const CameraSettings& settings);

}  // namespace chorus::camera

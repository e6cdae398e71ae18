// The runner that comes with Chorus: where it is, and whether it can run.
#pragma once

#include "common/base/result.h"
#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::camera {

/// The command that starts the runner, with the model: device.camera.runner or, if that is empty,
/// the runner that comes with Chorus.  NotFound when this runner is not there.
[[nodiscard]] Result<std::vector<std::string>> runner_command(const CameraSettings& settings);

/// Asks the runner that comes with Chorus whether it has everything it needs.  Other runners are
/// not checked.
[[nodiscard]] Result<void> check_runner(const CameraSettings& settings);

}  // namespace chorus::camera

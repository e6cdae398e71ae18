// The device `camera`: a webcam, a stream or a video file, and a runner that finds people in its
// pictures (proto/runner.md).
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/device_kinds.h"

namespace chorus::camera {

/// Makes the device and adds `/camera` to the context's router; the reader's finish() reports
/// mistakes.  An Error says what is missing: the file, the runner or its models.  A missing webcam
/// or stream is not an error, because it may appear later.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_camera(
    ConfigReader& section, const sensor_service::DeviceContext& context);

}  // namespace chorus::camera

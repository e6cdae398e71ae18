// The device `camera`: a webcam, a stream or a video file, and a runner that finds people in its
// pictures (proto/runner.md).
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/camera/picture.h"
#include "services/sensor/device/camera/runner_wire.h"
#include "services/sensor/device/device_kinds.h"

namespace chorus::camera {

/// Makes the device and adds `/camera` to the context's router; the reader's finish() reports
/// mistakes.  An Error says what is missing: the file, the runner or its models.  A missing webcam
/// or stream is not an error, because it may appear later.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_camera(
    ConfigReader& section, const sensor_service::DeviceContext& context);

/// One picture after the runner has looked at it.
struct LookedAt {
  const Picture& picture;
  const Lens& lens;
  Timestamp captured;
  bool somebody = false;                  ///< Whether anybody was found in it.
  const std::optional<PersonMask>& mask;  ///< If the runner gives masks.
};

/// Called on the camera's thread with every picture, before its capture is delivered.
using PictureWatch = std::function<void(const LookedAt& looked)>;

/// Like make_camera(), for devices that want the pictures themselves.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_watched_camera(
    ConfigReader& section, const sensor_service::DeviceContext& context, PictureWatch watch);

}  // namespace chorus::camera

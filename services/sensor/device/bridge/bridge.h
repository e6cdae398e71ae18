// The device `bridge`: programs in any language push frames to it (proto/bridge.md).
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/http/router.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/device_kinds.h"

namespace chorus::bridge {

/// Makes the device and adds `/push`, and `/capture/` with `/scan` if configured, to the context's
/// router; the reader's finish() reports mistakes. NotFound if the files of `/capture/` are
/// missing.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_bridge(
    ConfigReader& section, const sensor_service::DeviceContext& context);

}  // namespace chorus::bridge

// `/camera`: source, runner, rates, and what is wrong with them.
#pragma once

#include <memory>
#include <string>

#include "common/http/router.h"
#include "services/sensor/device/camera/camera_state.h"

namespace chorus::camera {

/// Adds `/camera`.  `source`: as told_source() gives it.  The router keeps the state alive.
void add_camera_route(http::Router& router, std::string source,
                      std::shared_ptr<const CameraState> state);

}  // namespace chorus::camera

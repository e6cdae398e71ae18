// Turns a runner's answer with "world" landmarks into one with "points".  No IO.
#pragma once

#include <string>
#include <string_view>

#include "services/sensor/device/bridge/hello.h"

namespace chorus::camera {

/// Returns the frame of `line`.  Bodies whose "pixels" and "world" fit each other have "points" in
/// the hello's axes, with covariances, instead of these.  Needs hello.camera and pixel_sigma.
/// Malformed when "world" is not as proto/runner.md specifies.
[[nodiscard]] Result<std::string> points_by_size(std::string_view line, const bridge::Hello& hello);

}  // namespace chorus::camera

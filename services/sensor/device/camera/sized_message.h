// An answer of a runner with "world" landmarks, turned into one with "points".  No IO.
#pragma once

#include <string>
#include <string_view>

#include "services/sensor/device/bridge/hello.h"

namespace chorus::camera {

/// The same frame; bodies with "pixels" and "world" that fit each other have "points" in the
/// hello's axes instead, with covariances.  Everything else stays as it is.  Needs hello.camera and
/// pixel_sigma.  Malformed when "world" is not as proto/runner.md says.
[[nodiscard]] Result<std::string> points_by_size(std::string_view line, const bridge::Hello& hello);

}  // namespace chorus::camera

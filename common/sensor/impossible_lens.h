// Lenses that no camera has: their focal length was stated in another unit than pixels.
#pragma once

#include <optional>
#include <string>

#include "common/sensor/camera_image.h"

namespace chorus {

struct LensObjection {
  const char* key;   ///< "fx" or "fy".
  std::string text;  ///< What is wrong with its value, and what it is counted in.
};

/// Why no camera can have this lens: its pictures would show more than 160 degrees, as with a focal
/// length in millimetres; none if one can.
[[nodiscard]] std::optional<LensObjection> objection_to(const Intrinsics& lens);

}  // namespace chorus

// Images of a scene as one sensor sees it: bodies made of capsules, and things, on a floor.
//
// Images are not mirrored: sensor x points to the sensor's left, so column = cx - fx x / z and row
// = cy - fy y / z.
#pragma once

#include "common/base/result.h"
#include "common/sensor/camera_image.h"
#include "common/synthetic/sensor_model.h"

namespace chorus::synthetic {

struct CameraModel {
  Intrinsics intrinsics;       ///< Pinhole; distortion is not rendered.
  double most_depth = 4.5;     ///< A larger depth becomes 0, as in the sensor [m].
  double depth_noise = 0.003;  ///< Standard deviation of depth [m]
  std::uint64_t seed = 1;
};

/// A 16-bit PNG of the depth along +z [mm], 0 where nothing was measured.
[[nodiscard]] Result<CameraImage> render_depth(const Scene& scene, std::size_t sensor,
                                               Timestamp instant, const CameraModel& camera);

/// An 8-bit JPEG.
[[nodiscard]] Result<CameraImage> render_color(const Scene& scene, std::size_t sensor,
                                               Timestamp instant, const CameraModel& camera);

}  // namespace chorus::synthetic

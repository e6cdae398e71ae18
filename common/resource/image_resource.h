// What a camera image shows and how to measure in it: capture time, size, intrinsics.
#pragma once

#include <string>

#include "common/resource/node.h"
#include "common/sensor/camera_image.h"

namespace chorus::resource {

/// Describes the image at `iri` ("images/depth"): intrinsics in pixels, distortion in OpenCV's
/// order; for a depth image also the size of its unit.
[[nodiscard]] Node image_node(const CameraImage& image, std::string iri);

}  // namespace chorus::resource

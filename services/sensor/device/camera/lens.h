// The direction that a pixel shows, and the uncertainty of that direction.
#pragma once

#include "common/base/result.h"
#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::camera {

struct Size {
  int width = 0;
  int height = 0;

  bool operator==(const Size&) const = default;
};

struct Lens {
  Intrinsics camera;         ///< For the whole picture; pixel centres are at whole coordinates.
  double focal_sigma = 0.0;  ///< Relative standard deviation of the focal length.
};

/// The lens for pictures of this size: the configured one, scaled if the pictures have the same
/// shape and another size; if none is configured, one made from the field of view.  InvalidArgument
/// if the configured lens is for another shape.
[[nodiscard]] Result<Lens> lens_for(const CameraSettings& settings, Size picture);

/// The size at which a picture is sent: at most `max_side` in either direction.
[[nodiscard]] Size sent_size(Size picture, int max_side);

/// The camera for landmarks in the picture of size `sent`, where [0, 0] is the upper left corner.
[[nodiscard]] Intrinsics sent_camera(const Intrinsics& camera, Size sent);

}  // namespace chorus::camera

// Which direction a pixel of a picture shows, and how sure that is.  Pure.
#pragma once

#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::camera {

struct Size {
  int width = 0;
  int height = 0;

  bool operator==(const Size&) const = default;
};

struct Lens {
  Intrinsics camera;         ///< Of the whole picture; a pixel's middle is at whole coordinates.
  double focal_sigma = 0.0;  ///< Standard deviation of the focal length, relative.
};

/// The lens for pictures of this size: the stated one, scaled when pictures are larger or smaller
/// in the same shape, else one from the field of view.  InvalidArgument when the stated one is for
/// another shape.
[[nodiscard]] Result<Lens> lens_for(const CameraSettings& settings, Size picture);

/// How large a picture is sent that is at most `max_side` in either direction.
[[nodiscard]] Size sent_size(Size picture, int max_side);

/// The camera for landmarks in a picture as it was sent, whose [0, 0] is the upper left corner.
[[nodiscard]] Intrinsics sent_camera(const Intrinsics& camera, Size sent);

/// How a ray turns with the relative error of the focal length [rad]: towards the camera's axis. In
/// sensor axes.
[[nodiscard]] Eigen::Vector3d turn_of_focal(const Eigen::Vector3d& ray);

/// Adds to a ray's covariance what an uncertain focal length does: nothing in the middle of the
/// picture, much at its edge.  Leaves points, and rays whose covariance is not known, alone.
void widen(Joint& joint, double focal_sigma);

}  // namespace chorus::camera

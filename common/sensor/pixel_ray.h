// From a pixel to the direction it shows.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/sensor/camera_image.h"

namespace chorus {

/// The unit vector through a pixel (u to the right, v down) in the camera's axes: x right, y down,
/// z ahead.  Undoes the distortion; none for pixels far outside the image, where that has no
/// solution.
[[nodiscard]] std::optional<Eigen::Vector3d> ray_of(const Eigen::Vector2d& pixel,
                                                    const Intrinsics& camera);

/// Covariance of that unit vector [rad^2] if both pixel coordinates have the standard deviation
/// `sigma` [px].  Distortion changes the direction, but hardly its error.
[[nodiscard]] Eigen::Matrix3d ray_covariance(const Eigen::Vector3d& ray, const Intrinsics& camera,
                                             double sigma);

}  // namespace chorus

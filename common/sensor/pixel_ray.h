// From a pixel to the direction it shows.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/body/skeleton.h"
#include "common/sensor/camera_image.h"

namespace chorus {

/// The unit vector through a pixel (u to the right, v down) in the camera's axes: x right, y down,
/// z ahead.  Corrects for distortion; none where that has no solution, for example far outside the
/// image.
[[nodiscard]] std::optional<Eigen::Vector3d> ray_of(const Eigen::Vector2d& pixel,
                                                    const Intrinsics& camera);

/// The pixel that shows a point in the camera's axes, by the lens's model; none behind the camera
/// (z of at most a millimetre; of a fisheye, more than 100 degrees from the axis, or where its
/// polynomial turns back).  The inverse of ray_of() where the lens has one.
[[nodiscard]] std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& in_camera,
                                                      const Intrinsics& camera);

/// How the pixel of a point ahead of the camera moves with the point, in the camera's axes [px/m]:
/// the derivative of pixel_of(), of a pinhole without that of its distortion.
[[nodiscard]] Eigen::Matrix<double, 2, 3> pixel_slope(const Eigen::Vector3d& in_camera,
                                                      const Intrinsics& camera);

/// How large a metre across the line of sight is at a point ahead of the camera [px/m]: of a
/// pinhole the focal length by the depth; of a fisheye the mean along and across the angle from the
/// axis.
[[nodiscard]] double pixels_per_metre(const Eigen::Vector3d& in_camera, const Intrinsics& camera);

/// Camera axes from sensor axes: x right, y down, z ahead from x left, y up, z ahead.
[[nodiscard]] inline Eigen::Matrix3d camera_from_sensor_axes() {
  return Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
}

/// Covariance of the unit vector of a pixel's direction [rad^2] if both pixel coordinates have the
/// standard deviation `sigma` [px].  Distortion changes the direction, but hardly its error.
[[nodiscard]] Eigen::Matrix3d ray_covariance(const Eigen::Vector3d& ray, const Intrinsics& camera,
                                             double sigma);

/// Derivative of a ray with respect to the relative error of the focal length [rad]: with a larger
/// focal length, the ray turns towards the camera's axis, +z.  Of a pinhole; of a fisheye it is up
/// to twice as large at the edge of the picture.
[[nodiscard]] Eigen::Vector3d turn_of_focal(const Eigen::Vector3d& ray);

/// Adds the effect of an uncertain focal length (relative standard deviation `focal_sigma`) to a
/// ray's covariance: zero in the middle of the picture, largest at its edge.  In sensor axes.
/// Leaves points, and rays without a known covariance, unchanged.
void widen_ray(Joint& joint, double focal_sigma);

}  // namespace chorus

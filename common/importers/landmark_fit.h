// Places the landmarks of one picture as a metric body in front of the camera: perspective-n-point.
//
// The detector gives the body in metres about its hips and, separately, the pixel of each landmark.
// The pose that projects the body onto these pixels places it in front of the camera.  Its depth is
// as accurate as the detector's guess of the person's size (decimetres), its bearing as accurate as
// the pixels.  So each landmark takes its depth from the fit and its lateral position from its own
// pixel ray.  The lateral error is then 15-35 mm, against 31-48 mm for the rigid fit
// (tests/bench/accuracy/real_bench.cpp).
#pragma once

#include <optional>

#include "common/base/result.h"
#include "common/importers/landmarks.h"
#include "common/sensor/camera_image.h"

namespace chorus::importers {

/// Where the fit puts the landmarks.
enum class Lateral {
  PixelRay,   ///< Depth from the fit, direction from the landmark's own pixel.
  RigidBody,  ///< The fitted body unchanged: the usual method, for comparison.
};

/// Fits the landmarks; the result is in sensor space (x to the sensor's left, y up, z into the
/// scene). kTrackedVisibility decides their states; landmarks behind the camera are NotTracked.
/// Fails when the pixels fit no body in front of the camera.
[[nodiscard]] Result<Landmarks> fit_landmarks(const DetectedLandmarks& detected,
                                              const Intrinsics& intrinsics,
                                              Lateral lateral = Lateral::PixelRay);

/// The orientation of the head (layout::head_turn's axes) in sensor space: that of a face whose
/// marks fall on their pixels.  The detector's own face in metres is lopsided (its right eye is 2
/// cm higher) and turns along with the shoulders: of a head that turns on them, a third is left.
/// None if the pixels fit no body or no face.
[[nodiscard]] std::optional<Eigen::Quaterniond> fit_head(const DetectedLandmarks& detected,
                                                         const Intrinsics& intrinsics);

/// The error of a joint made from fitted landmarks: 25 mm across the line of sight, and 6 % of the
/// distance along it, because the person's size is a guess; twice as much for an Inferred joint.
[[nodiscard]] Covariance fit_error(const Joint& joint);

/// Only the rays through the landmarks' pixels, in sensor space; without such a ray, a landmark is
/// NotTracked.
[[nodiscard]] Landmarks landmark_rays(const DetectedLandmarks& detected,
                                      const Intrinsics& intrinsics);

/// Turns OpenCV camera axes (x right, y down, z ahead) by a half turn about z into ours; it is its
/// own inverse.
[[nodiscard]] inline Eigen::Matrix3d sensor_from_opencv() {
  return Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
}

}  // namespace chorus::importers

// Places one image's landmarks as a metric body in front of the camera: perspective-n-point.
//
// The detector gives the body in metres about its own hips and, separately, the pixel of each
// landmark.  The pose that projects the body onto these pixels places it in front of the camera;
// its depth is as good as the detector's guess of the person's size (decimetres), its bearing as
// good as the pixels.  So each landmark takes its depth from the fit and its lateral place from its
// own pixel ray: the lateral error is then 15-35 mm, against 31-48 mm for the rigid fit
// (tests/bench/accuracy/real_bench.cpp).
#pragma once

#include "common/base/result.h"
#include "common/importers/landmarks.h"
#include "common/sensor/camera_image.h"

namespace chorus::importers {

/// Where the fit puts the landmarks.
enum class Lateral {
  PixelRay,   ///< Depth from the fit, direction from the landmark's own pixel.
  RigidBody,  ///< The fitted body unchanged: the usual method, kept for comparison.
};

/// In sensor space (x to the sensor's left, y up, z into the scene).  The state follows from
/// kTrackedVisibility; landmarks that turn out behind the camera are NotTracked.  Fails when the
/// pixels fit no body in front of the camera.
[[nodiscard]] Result<Landmarks> fit_landmarks(const DetectedLandmarks& detected,
                                              const Intrinsics& intrinsics,
                                              Lateral lateral = Lateral::PixelRay);

/// What a joint made of fitted landmarks errs by: 25 mm across the line of sight, and along it 6 %
/// of the distance, which a wrong guess of the person's size costs; twice as much when it is
/// Inferred.
[[nodiscard]] Covariance fit_error(const Joint& joint);

/// Only the rays through the pixels, in sensor space; a landmark without a pixel ray is NotTracked.
[[nodiscard]] Landmarks landmark_rays(const DetectedLandmarks& detected,
                                      const Intrinsics& intrinsics);

/// OpenCV camera axes (x right, y down, z ahead) turned by a half turn about z; sensor_from_opencv
/// is its own inverse.
[[nodiscard]] inline Eigen::Matrix3d sensor_from_opencv() {
  return Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
}

}  // namespace chorus::importers

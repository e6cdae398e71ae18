// One image's landmarks as a metric body before the camera: perspective-n-point.
//
// The detector gives the body in metres about its own hips and, separately, the pixel of each
// landmark.  The pose that projects the former onto the latter places the body before the camera;
// its depth is as good as the detector's guess of the person's size (decimetres), its bearing as
// good as the pixels.  So each landmark takes its depth from the fit and its lateral place from its
// own pixel ray: the lateral error is then 15-35 mm, against 31-48 mm for the rigid fit
// (tests/bench/accuracy/real_bench.cpp).
#pragma once

#include "common/base/result.h"
#include "common/importers/landmarks.h"
#include "common/sensor/camera_image.h"

namespace chorus::importers {

/// Where landmarks go after the fit.
enum class Lateral {
  PixelRay,   ///< Depth from the fit, direction from the landmark's own pixel.
  RigidBody,  ///< The fitted body as it is: the plain recipe, kept for comparison.
};

/// In sensor space (x to the sensor's left, y up, z into the scene).  State by kTrackedVisibility;
/// landmarks that come out behind the camera are NotTracked.  Fails when the pixels fit no body
/// before the camera.
[[nodiscard]] Result<Landmarks> fit_landmarks(const DetectedLandmarks& detected,
                                              const Intrinsics& intrinsics,
                                              Lateral lateral = Lateral::PixelRay);

/// The rays of the pixels alone, in sensor space; a landmark whose pixel has none is NotTracked.
[[nodiscard]] Landmarks landmark_rays(const DetectedLandmarks& detected,
                                      const Intrinsics& intrinsics);

/// OpenCV camera axes (x right, y down, z ahead) turned half about z: sensor_from_opencv is its own
/// inverse.
[[nodiscard]] inline Eigen::Matrix3d sensor_from_opencv() {
  return Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
}

}  // namespace chorus::importers

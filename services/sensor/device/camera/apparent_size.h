// How far away somebody is, from how large he appears: a body in metres, of the size that a model
// gives everybody, is moved until its landmarks lie on their rays.  Pure.
//
// The direction of a landmark stays that of its own pixel; only its depth comes from the fit, and
// is as good as the guess of the person's size.  On the bundled video depths were off by 4 % with a
// spread of 0.15 m over the joints (BlazePose).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/body/skeleton.h"

namespace chorus::camera {

/// One landmark, in the camera's axes: x right, y down, z ahead.
struct SizedLandmark {
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();            ///< Unit vector towards it.
  Eigen::Vector3d shape = Eigen::Vector3d::Zero();           ///< About a point of the body [m].
  double weight = 0.0;                                       ///< 0: not seen.
  Eigen::Matrix3d ray_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2]
};

struct PlacedLandmark {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  /// [m^2], of this landmark against the others.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// One for each landmark, also for those that are not seen.  Nothing when too few are seen, or they
/// fit no body before the camera: their rays are all that is known then.
[[nodiscard]] std::optional<std::vector<PlacedLandmark>> placed_by_size(
    std::span<const SizedLandmark> landmarks);

/// Adds to a point's covariance what all joints of a person have in common: nobody knows his size,
/// a tenth of the distance, nor exactly the focal length (its relative standard deviation).  Leaves
/// rays, and points whose covariance is not known, alone.
void widen_depth(Joint& joint, double focal_sigma);

}  // namespace chorus::camera

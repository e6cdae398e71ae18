// Where a suit is by its steps alone, and how uncertain that has become.
#pragma once

#include "common/suit/footing.h"

namespace chorus::suit {

struct Walked {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Of SpineBase; y: above the floor [m].
  Stance stance = Stance::Unknown;
  double distance = 0.0;                                 ///< Walked so far [m].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of the place [m^2].
};

/// Adds up steps, beginning at the origin.
class Walk {
 public:
  explicit Walk(double stature = 1.75) : footing_(stature) {}
  const Walked& next(const SuitPose& pose);

 private:
  Footing footing_;
  Walked walked_{};
};

/// The body in the space in which it began to walk: y = 0 is the floor, and all joints share the
/// place's covariance (in addition to `pose_sigma`, that of the pose itself [m]).
[[nodiscard]] Skeleton<WorldSpace> walked_body(const SuitPose& pose, const Walked& walked,
                                               double pose_sigma);

}  // namespace chorus::suit

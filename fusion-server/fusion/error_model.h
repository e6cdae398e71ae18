// How uncertain one view's measurement of one joint is, for every method of fusion.
//
// A measurement's own covariance is used where it has one, but none is believed to be better than 3
// mm, or 1 mrad of a ray (decision 0094).  Otherwise a ray has the same error in all directions,
// and a point is precise across the line of sight and imprecise along it:
//   Sigma = across^2 I + (along^2 - across^2) r r^T,   r = unit vector from eye to joint
#pragma once

#include <map>
#include <memory>

#include "fusion-server/flow/person.h"
#include "fusion-server/fusion/noise_model.h"

namespace chorus::fusion {

struct JointError {
  /// Covariance of the joint's position [m^2], or of its ray's direction [rad^2], in world axes.  A
  /// position's is positive definite; a direction's need not be, because only its part across the
  /// ray counts.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  /// True if it contains the pose error (pose_error.h), which otherwise comes on top of it.
  bool whole = false;
};

class ErrorModel {
 public:
  virtual ~ErrorModel() = default;
  /// Call this only for joints that have a position or direction in the view.
  [[nodiscard]] virtual JointError error(const SensorView& view, JointId joint) const = 0;

  [[nodiscard]] Eigen::Matrix3d covariance(const SensorView& view, JointId joint) const {
    return error(view, joint).covariance;
  }
};

/// The same noise for all sensors except those that have their own.
[[nodiscard]] std::unique_ptr<const ErrorModel> line_of_sight_errors(
    const NoiseModel& noise, const std::map<SensorId, NoiseModel>& of_sensors);

/// The formula above for one joint seen from `eye`, both in world [m]; isotropic when the eye is at
/// the joint or unknown.
[[nodiscard]] Eigen::Matrix3d line_of_sight_covariance(const Joint& joint,
                                                       const Eigen::Vector3d& eye,
                                                       const NoiseModel& noise);

}  // namespace chorus::fusion

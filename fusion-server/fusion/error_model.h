// How uncertain one view's measurement of one joint is, for every method of fusion.
//
// A measurement with a covariance of its own is believed.  Otherwise a ray errs alike in all
// directions, and a sensor of points is sharp across its line of sight and blunt along it:
//   Sigma = across^2 I + (along^2 - across^2) r r^T,   r = unit ray eye -> joint
#pragma once

#include <map>
#include <memory>

#include "fusion-server/flow.h"
#include "fusion-server/fusion/noise_model.h"

namespace chorus::fusion {

class ErrorModel {
 public:
  virtual ~ErrorModel() = default;
  /// Of the joint's position [m^2], or of its ray's direction [rad^2], in world axes.  That of a
  /// position is positive definite; that of a direction need not be, because only what is across
  /// the ray counts.  Asked only for joints that are given in the view.
  [[nodiscard]] virtual Eigen::Matrix3d covariance(const SensorView& view, JointId joint) const = 0;
};

/// One noise for all sensors except those that have their own.
[[nodiscard]] std::unique_ptr<const ErrorModel> line_of_sight_errors(
    const NoiseModel& noise, const std::map<SensorId, NoiseModel>& of_sensors);

/// The formula above for one joint seen from `eye`, both in world [m]; isotropic when the eye is in
/// the joint or unknown.
[[nodiscard]] Eigen::Matrix3d line_of_sight_covariance(const Joint& joint,
                                                       const Eigen::Vector3d& eye,
                                                       const NoiseModel& noise);

}  // namespace chorus::fusion

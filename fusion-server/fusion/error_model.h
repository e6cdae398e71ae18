// How uncertain one view's measurement of one joint is: what every method of fusion asks.
//
// A measurement that brings its own covariance is believed.  Else a sensor is sharp across its line
// of sight and blunt along it:
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
  /// Of the joint's position in world axes [m^2]; positive definite.  Asked only where the view has
  /// a place for the joint.
  [[nodiscard]] virtual Eigen::Matrix3d covariance(const SensorView& view, JointId joint) const = 0;
};

/// One noise for all sensors but those that have their own.
[[nodiscard]] std::unique_ptr<const ErrorModel> line_of_sight_errors(
    const NoiseModel& noise, const std::map<SensorId, NoiseModel>& of_sensors);

/// The formula above for one joint seen from `eye`, both in world [m]; an eye in the joint, or
/// none, leaves the noise round.
[[nodiscard]] Eigen::Matrix3d line_of_sight_covariance(const Joint& joint,
                                                       const Eigen::Vector3d& eye,
                                                       const NoiseModel& noise);

}  // namespace chorus::fusion

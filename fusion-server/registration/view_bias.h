// The bias that no length of walk shows: sensors that see a body from different sides place its
// joints differently.
//
// Apart from noise, the error of a view is a function of the angle phi between the way the person
// walks and the direction to the sensor, b(phi) = c_0 + c_1 cos phi + c_2 sin phi + c_3 cos 2 phi +
// c_4 sin 2 phi, where each c has a part along the view, aside and upwards, and each sensor has its
// own c's.  They are not estimated, but considered (Schmidt 1966): with g = G c in the scores of
// the walk, an estimate P g has the further covariance P (sum sigma^2 G G^T) P^T. Where the person
// turns as the place changes, as on a circle, a walk cannot distinguish b from a turned sensor: P G
// is large, and the residuals do not show it.  docs/papers/registration.md, Section 8.
#pragma once

#include <optional>

#include "fusion-server/registration/point_elimination.h"

namespace chorus::registration {

/// Collects the scores that unit coefficients of the bias would cause.
class ViewBias {
 public:
  /// `coefficient`: standard deviation of each c [m].
  ViewBias(std::vector<Eigen::Vector3d> eyes, double coefficient);

  /// Adds one point, as the adjustment counts it.  `at`: where it is, world; `walking`: the
  /// direction in which the person walks there; if none, only c_0 is counted.
  void add(const PointMeasurements& measurements, const FusedPoint& fused, double weight,
           const Eigen::Vector3d& at, const std::optional<Eigen::Vector3d>& walking);

  /// sum sigma^2 G G^T, of (omega, tau) of every sensor and the depth bias.
  [[nodiscard]] Eigen::MatrixXd scores() const;

 private:
  std::vector<Eigen::Vector3d> eyes_;     ///< Positions of the sensors, world [m].
  double coefficient_;                    ///< [m]
  std::vector<Eigen::MatrixXd> effects_;  ///< G of each sensor.
};

}  // namespace chorus::registration

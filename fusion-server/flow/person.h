// What fusion is given: the views of one person at one instant.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/base/strong_id.h"
#include "common/body/skeleton.h"
#include "fusion-server/flow/aligned_sensor.h"
#include "fusion-server/flow/worn_limb.h"

namespace chorus {

/// One sensor's view of one person at the common instant, with everything that fusion needs to know
/// about the view.
struct SensorView {
  SensorId sensor;
  BodyId body;
  Basis basis = Basis::Exact;
  /// Distance from sensor to neck [m]; NaN: unknown.
  double distance = std::numeric_limits<double>::quiet_NaN();
  double facing = std::numeric_limits<double>::quiet_NaN();   ///< Otto Eq. (2) phi [rad].
  double bearing = std::numeric_limits<double>::quiet_NaN();  ///< Otto Eq. (3) alpha [rad].
  double weight = 0.0;                            ///< Product of Eqs. (1)-(3), in [0, 1].
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Sensor position in world [m].
  /// Extrinsics::covariance of the sensor; zero: its place is exact, or nothing is known of it.
  Eigen::Matrix<double, 6, 6> place_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Skeleton<WorldSpace> skeleton;
};

/// All views of one person at one instant.
struct Person {
  PersonId id;
  std::vector<SensorView> views;
  /// Probability that left and right are not swapped; none if the sides were not resolved.
  std::optional<double> sides_confidence = {};
  /// Where the middle of the person is expected, world [m].  Set only if no sensor sees the person;
  /// then there are no views.
  std::optional<Eigen::Vector3d> carried = {};
  /// What inertial sensors on the person say of their limbs; empty: they wear none, or fusion is
  /// not to use them.
  std::vector<WornLimb> worn = {};
};

}  // namespace chorus

// A limb's orientation as the tracker and as the sensor on it give it, at one instant.
//
// F^LT -> F^GT: world_from_limb, the paper's q^T(t); F^LI -> F^GI: inertial_from_sensor, q^I(t)
// (Baak et al., 3.1-3.2).  Both worlds have +y up.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::evaluation {

/// What a tracker knows of a limb's orientation.
struct TrackedOrientation {
  Eigen::Quaterniond world_from_limb = Eigen::Quaterniond::Identity();
  /// Of its rotation vector in limb axes [rad^2].  Along an axis about which the tracker sees
  /// nothing (the twist of a straight limb) it is large.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// False where the twist about the limb's +y (the bone) cannot be seen: only the swing counts.
  bool twist_seen = true;
};

struct OrientationPair {
  double time = 0.0;  ///< [s], any origin
  TrackedOrientation tracked;
  Eigen::Quaterniond inertial_from_sensor = Eigen::Quaterniond::Identity();
};

using OrientationPairs = std::vector<OrientationPair>;

/// A quantity of one limb or sensor in time order; times in seconds.
template <class Value>
struct Timed {
  double time = 0.0;
  Value value;
};
using OrientationTrack = std::vector<Timed<Eigen::Quaterniond>>;

}  // namespace chorus::evaluation

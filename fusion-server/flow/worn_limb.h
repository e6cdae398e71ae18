// What a calibrated inertial sensor says of the limb that wears it, at a common instant.
#pragma once

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/inertial/limb.h"

namespace chorus {

/// Axes of a limb as in evaluation/limb_frame.h: +y along its bone.
struct WornLimb {
  SensorId source;  ///< The inertial source, such as a suit.
  inertial::Limb limb = inertial::Limb::Pelvis;
  Eigen::Quaterniond world_from_limb = Eigen::Quaterniond::Identity();
  /// Of its rotation vector about the axes of the world [rad^2]: calibration, the sensor's movement
  /// on the limb, and the time since the limb was last seen.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

}  // namespace chorus

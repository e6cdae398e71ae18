// How a worn inertial sensor sits on its limb and where its heading points: the calibration value.
//
// Baak et al., Eq. (3): q^I(t) = conj(q^G) q^T(t) q^L.  Here
//   q^L = limb_from_sensor (the mount: takes F^LI to F^LT),
//   q^G = world_from_inertial.  Both worlds have +y up, so it is a heading alone: about_y(heading).
// So a sensor predicts its limb as
//   world_from_limb = about_y(heading) * inertial_from_sensor * conj(limb_from_sensor).
// The paper has one q^G for all sensors; real suits do not (inertial_frame.h).
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/inertial/limb.h"
#include "common/time/timestamp.h"

namespace chorus::inertial {

struct SensorCalibration {
  std::string sensor;  ///< InertialReading::sensor
  Limb limb = Limb::Pelvis;
  double heading = 0.0;  ///< About +y [rad].
  Eigen::Quaterniond limb_from_sensor = Eigen::Quaterniond::Identity();
  /// Of (heading; rotation vector of the mount in limb axes, true = exp(error) * stated) [rad^2].
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  /// Median angle between the tracked limb and the predicted one in the calibration take [rad].
  double residual = 0.0;
  /// Standard error of a prediction that the calibration alone causes, in the worst pose of the
  /// limb [rad]: heading and mount, not the noise of the instant.  Where the calibration take never
  /// showed the limb's twist, of the bone's direction alone.
  double prediction_sigma = 0.0;
};

/// All sensors of one source on one person.
struct InertialCalibration {
  std::string source;
  Timestamp made;
  std::vector<SensorCalibration> sensors;
};

/// The calibration of the sensor with this name; nullptr if there is none.
[[nodiscard]] const SensorCalibration* find_sensor(const InertialCalibration& calibration,
                                                   std::string_view sensor);

/// The limb's orientation that the sensor predicts, world_from_limb (Eq. 3 solved for q^T).
[[nodiscard]] Eigen::Quaterniond predicted_limb(const SensorCalibration& calibration,
                                                const Eigen::Quaterniond& inertial_from_sensor);

/// Covariance of that prediction's rotation vector in world axes that heading and mount cause, and
/// `reading_covariance` (in inertial space) of the orientation itself [rad^2].
[[nodiscard]] Eigen::Matrix3d prediction_covariance(const SensorCalibration& calibration,
                                                    const Eigen::Quaterniond& world_from_limb,
                                                    const Eigen::Matrix3d& reading_covariance);

}  // namespace chorus::inertial

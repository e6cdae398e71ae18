#include "common/inertial/calibration.h"

#include <algorithm>

#include "common/geometry/rotation.h"

namespace chorus::inertial {

const SensorCalibration* find_sensor(const InertialCalibration& calibration,
                                     std::string_view sensor) {
  const auto found = std::ranges::find(calibration.sensors, sensor, &SensorCalibration::sensor);
  return found == calibration.sensors.end() ? nullptr : &*found;
}

Eigen::Quaterniond predicted_limb(const SensorCalibration& calibration,
                                  const Eigen::Quaterniond& inertial_from_sensor) {
  return normalised_or_identity(about_y(calibration.heading) * inertial_from_sensor *
                                calibration.limb_from_sensor.conjugate());
}

Eigen::Matrix3d prediction_covariance(const SensorCalibration& calibration,
                                      const Eigen::Quaterniond& world_from_limb,
                                      const Eigen::Matrix3d& reading_covariance) {
  // A small turn of the heading turns the prediction about +y; one of the mount, exp(m) in limb
  // axes, by -m in limb axes.
  Eigen::Matrix<double, 3, 4> by;
  by.col(0) = Eigen::Vector3d::UnitY();
  by.rightCols<3>() = -world_from_limb.toRotationMatrix();
  const Eigen::Matrix3d world_from_inertial = about_y(calibration.heading).toRotationMatrix();
  return by * calibration.covariance * by.transpose() +
         world_from_inertial * reading_covariance * world_from_inertial.transpose();
}

}  // namespace chorus::inertial

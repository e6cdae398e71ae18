// VQF: orientation from gyroscope, accelerometer and, if there is one, magnetometer.
//
// D. Laidig, T. Seel: VQF: Highly accurate IMU orientation estimation with bias estimation and
// magnetic disturbance rejection, Information Fusion 91 (2023); written from the paper.  The
// orientation is a product of three: the gyroscope alone, integrated (I_i from S_i), a tilt that
// brings the low-passed acceleration upright (E_i from I_i), and a heading offset delta (E from
// E_i), Eqs. (1)-(4).  A Kalman filter estimates the gyroscope's bias from the tilt corrections, or
// at rest from the mean rate.  A field whose norm or dip is unlike the reference's does not turn
// the heading.
#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/inertial/imu_sample.h"

namespace chorus::inertial {

/// The paper's parameters (Table 2) with the paper's values.
struct VqfOptions {
  double tau_acceleration = 3.0;  ///< Of tilt [s]
  double tau_field = 9.0;         ///< Of heading [s]
  // Turned off one by one, the basic version of the paper remains.
  bool bias_in_motion = true;
  bool bias_at_rest = true;
  bool rejects_disturbed_fields = true;
};

struct VqfState {
  Eigen::Quaterniond six_axis = Eigen::Quaterniond::Identity();   ///< E_i from sensor.
  Eigen::Quaterniond nine_axis = Eigen::Quaterniond::Identity();  ///< East-north-up from sensor.
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();                 ///< Of the gyroscope [rad/s].
  Eigen::Matrix3d bias_covariance = Eigen::Matrix3d::Zero();      ///< [rad^2/s^2]
  bool at_rest = false;
  bool field_disturbed = true;  ///< Until a field has been accepted as the earth's.
};

class Vqf {
 public:
  /// Samples come every `period` seconds.
  explicit Vqf(double period, const VqfOptions& options = {});
  Vqf(Vqf&&) noexcept;
  Vqf& operator=(Vqf&&) noexcept;
  ~Vqf();

  /// One sample.  Parts that are not finite, or an acceleration or field of length zero, are not
  /// used.
  void update(const ImuSample& sample);
  [[nodiscard]] const VqfState& state() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::inertial

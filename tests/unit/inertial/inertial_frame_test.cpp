#include "common/inertial/inertial_frame.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/inertial/calibration.h"

namespace chorus::inertial {
namespace {

InertialReading reading(std::string name) {
  InertialReading out;
  out.sensor = std::move(name);
  out.inertial_from_sensor = Eigen::Quaterniond(1, 0, 0, 0);
  return out;
}

TEST(InertialFrame, RefusesByName) {
  InertialFrame frame;
  frame.readings = {reading("a"), reading("a")};
  EXPECT_EQ(checked(frame).error().context, "sensor a");
  frame.readings = {reading("")};
  EXPECT_FALSE(checked(frame));
  frame.readings = {reading("a"), reading("b")};
  frame.readings[1].inertial_from_sensor = Eigen::Quaterniond(0, 0, 0, 0);
  EXPECT_EQ(checked(frame).error().context, "sensor b");
  frame.readings[1].inertial_from_sensor = Eigen::Quaterniond(1.01, 0, 0, 0);
  const auto fine = checked(frame);
  ASSERT_TRUE(fine);
  EXPECT_DOUBLE_EQ(fine->readings[1].inertial_from_sensor->norm(), 1.0);
  frame.readings[0].rate = Eigen::Vector3d(NAN, 0, 0);
  EXPECT_EQ(checked(frame).error().context, "sensor a");
  frame.readings.assign(kMaxInertialSensors + 1, reading("a"));
  EXPECT_EQ(checked(frame).error().code, ErrorCode::TooLarge);
}

TEST(InertialFrame, TurnsUpwardUpward) {
  EXPECT_TRUE((y_up_from_z_up() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE((y_up_from_z_up() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(Limb, IsFoundInTheSpellingsOfMakers) {
  EXPECT_EQ(limb_meant_by("LeftLowerLeg"), Limb::ShankLeft);
  EXPECT_EQ(limb_meant_by("tibia_r_imu"), Limb::ShankRight);
  EXPECT_EQ(limb_meant_by("L_LowLeg2"), Limb::ShankLeft);
  EXPECT_EQ(limb_meant_by("Sternum"), Limb::Chest);
  EXPECT_EQ(limb_meant_by("RightForeArm"), Limb::ForearmRight);
  EXPECT_EQ(limb_meant_by("L_UpArm"), Limb::UpperArmLeft);
  EXPECT_EQ(limb_meant_by("pelvis_imu"), Limb::Pelvis);
  EXPECT_EQ(limb_meant_by("HandRight"), Limb::HandRight);
  EXPECT_FALSE(limb_meant_by("foot"));
  EXPECT_FALSE(limb_meant_by("00B40B91"));
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const auto limb = static_cast<Limb>(i);
    EXPECT_EQ(limb_named(name_of(limb)), limb);
    EXPECT_EQ(mirror_of(mirror_of(limb)), limb);
    EXPECT_EQ(group_of(mirror_of(limb)), group_of(limb));
  }
  EXPECT_EQ(mirror_of(Limb::HandLeft), Limb::HandRight);
  EXPECT_EQ(mirror_of(Limb::FootRight), Limb::FootLeft);
}

TEST(Calibration, PredictsTheLimbOfEquation3AndItsCovariance) {
  SensorCalibration calibration;
  calibration.heading = 0.7;
  calibration.limb_from_sensor = exp_map({0.3, -0.2, 0.5});
  const Eigen::Quaterniond limb = exp_map({0.1, 0.9, -0.4});
  const Eigen::Quaterniond reading =
      about_y(-calibration.heading) * limb * calibration.limb_from_sensor;
  EXPECT_LT(angular_distance(predicted_limb(calibration, reading), limb), 1e-12);

  // Against differences: turn one parameter by a little and see where the prediction goes.
  calibration.covariance = Eigen::Vector4d(4, 1, 2, 3).asDiagonal();
  Eigen::Matrix<double, 3, 4> by;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 4; ++i) {
    SensorCalibration other = calibration;
    if (i == 0) other.heading += kStep;
    if (i > 0)
      other.limb_from_sensor =
          exp_map(kStep * Eigen::Vector3d::Unit(i - 1)) * calibration.limb_from_sensor;
    by.col(i) = log_map(predicted_limb(other, reading) * limb.conjugate()) / kStep;
  }
  const Eigen::Matrix3d wanted = by * calibration.covariance * by.transpose();
  EXPECT_TRUE(
      prediction_covariance(calibration, limb, Eigen::Matrix3d::Zero()).isApprox(wanted, 1e-4));
}

}  // namespace
}  // namespace chorus::inertial

#include "common/body/interpolate.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus {
namespace {

Skeleton<SensorSpace> body_at(double x) {
  Skeleton<SensorSpace> body;
  Joint& neck = body[JointId::Neck];
  neck.position = {x, 1.4, 2.5};
  neck.orientation = Eigen::Quaterniond::Identity();
  neck.state = JointState::Tracked;
  return body;
}

TEST(Interpolate, TheWorseStateAndTheNearerSignWin) {
  Skeleton<SensorSpace> a = body_at(0);
  Skeleton<SensorSpace> b = body_at(1);
  b[JointId::Neck].state = JointState::Inferred;
  b[JointId::Neck].orientation.coeffs() = -about_y(deg(20)).coeffs();
  const Joint neck = interpolate(a, b, 0.5)[JointId::Neck];
  EXPECT_EQ(neck.state, JointState::Inferred);
  EXPECT_NEAR(angular_distance(neck.orientation, about_y(deg(10))), 0.0, 1e-9);
}

TEST(Interpolate, AJointUnseenAtOneEndIsNotTracked) {
  const Skeleton<SensorSpace> a = body_at(0);
  Skeleton<SensorSpace> b = a;
  b[JointId::Neck].position.x() = std::numeric_limits<double>::quiet_NaN();
  const Joint neck = interpolate(a, b, 0.5)[JointId::Neck];
  EXPECT_EQ(neck.state, JointState::NotTracked);
  EXPECT_EQ(neck.position, Eigen::Vector3d::Zero());
}

TEST(Interpolate, AMissingOrientationStaysMissing) {
  const Skeleton<SensorSpace> a = body_at(0);
  Skeleton<SensorSpace> b = a;
  b[JointId::Neck].orientation = Eigen::Quaterniond(0, 0, 0, 0);
  EXPECT_EQ(interpolate(a, b, 0.5)[JointId::Neck].orientation.coeffs().norm(), 0.0);
}

TEST(Interpolate, RaysStayUnitVectorsAndCovariancesAreMixed) {
  Skeleton<SensorSpace> a;
  a[JointId::Neck] = {Eigen::Vector3d::UnitX(), Eigen::Quaterniond(0, 0, 0, 0), JointState::Tracked,
                      Measurement::Ray};
  a[JointId::Neck].covariance = Covariance(Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity()));
  Skeleton<SensorSpace> b = a;
  b[JointId::Neck].position = Eigen::Vector3d::UnitY();
  b[JointId::Neck].covariance = Covariance(Eigen::Matrix3d(3e-4 * Eigen::Matrix3d::Identity()));
  const Joint neck = interpolate(a, b, 0.5)[JointId::Neck];
  EXPECT_TRUE(neck.bears());
  EXPECT_NEAR(neck.position.norm(), 1.0, 1e-12);
  EXPECT_NEAR(neck.position.x(), neck.position.y(), 1e-12);
  EXPECT_NEAR(neck.covariance.matrix()(1, 1), 2e-4, 1e-9);
}

TEST(Interpolate, APointAndARayHaveNothingBetweenThem) {
  Skeleton<SensorSpace> a;
  a[JointId::Neck] = {Eigen::Vector3d::UnitX(), Eigen::Quaterniond(0, 0, 0, 0), JointState::Tracked,
                      Measurement::Ray};
  Skeleton<SensorSpace> b = a;
  b[JointId::Neck].measurement = Measurement::Point;
  EXPECT_EQ(interpolate(a, b, 0.5)[JointId::Neck].state, JointState::NotTracked);
}

TEST(Interpolate, NeverExtrapolates) {
  const Skeleton<SensorSpace> a = body_at(0);
  const Skeleton<SensorSpace> b = body_at(1);
  EXPECT_DOUBLE_EQ(interpolate(a, b, 2.0)[JointId::Neck].position.x(), 1.0);
  EXPECT_DOUBLE_EQ(interpolate(a, b, -1.0)[JointId::Neck].position.x(), 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DOUBLE_EQ(interpolate(a, b, nan)[JointId::Neck].position.x(), 0.0);
}

}  // namespace
}  // namespace chorus

#include "common/body/covariance.h"

#include <gtest/gtest.h>

#include <limits>

#include <Eigen/Geometry>

namespace chorus {
namespace {

Eigen::Matrix3d sample() {
  Eigen::Matrix3d m;
  m << 4, 1, 0.5, 1, 3, -0.25, 0.5, -0.25, 2;
  return 1e-4 * m;
}

TEST(Covariance, IsUnknownUntilItIsGiven) {
  EXPECT_FALSE(Covariance().known());
  EXPECT_EQ(Covariance().matrix(), Eigen::Matrix3d::Zero());
  EXPECT_FALSE(Covariance().turned(Eigen::Matrix3d::Identity()).known());
}

TEST(Covariance, GivesBackWhatItTook) {
  EXPECT_TRUE(Covariance(sample()).matrix().isApprox(sample(), 1e-6));
  EXPECT_FLOAT_EQ(static_cast<float>(Covariance(sample()).term(4)), -0.25e-4F);
}

TEST(Covariance, TurnsWithTheAxes) {
  const Eigen::Matrix3d quarter =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Covariance along_z(Eigen::Vector3d(1e-4, 2e-4, 9e-4).asDiagonal().toDenseMatrix());
  const Eigen::Matrix3d turned = along_z.turned(quarter).matrix();  // z of a becomes x of b
  EXPECT_NEAR(turned(0, 0), 9e-4, 1e-9);
  EXPECT_NEAR(turned(1, 1), 2e-4, 1e-9);
  EXPECT_NEAR(turned(2, 2), 1e-4, 1e-9);
  EXPECT_NEAR(turned(0, 2), 0.0, 1e-9);
}

TEST(Covariance, IsPlausibleWithoutNegativeVariances) {
  EXPECT_TRUE(Covariance(sample()).plausible());
  EXPECT_TRUE(Covariance(Eigen::Matrix3d::Zero().eval()).plausible());
  Eigen::Matrix3d odd = sample();
  odd(0, 1) = odd(1, 0) = 5e-4;  // more than the variances allow
  EXPECT_FALSE(Covariance(odd).plausible());
  odd(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Covariance(odd).plausible());
}

TEST(Covariance, BetweenTwoIsKnownWhereBothAre) {
  const Covariance one(sample());
  const Covariance two(Eigen::Matrix3d(3.0 * sample()));
  EXPECT_TRUE(between(one, two, 0.5).matrix().isApprox(2.0 * sample(), 1e-6));
  EXPECT_FALSE(between(one, {}, 0.5).known());
}

}  // namespace
}  // namespace chorus

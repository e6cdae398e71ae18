#include "common/geometry/error_radius.h"

#include <random>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace chorus {
namespace {

TEST(RadiusOf95, OfARoundAndOfAnInfinitelyNarrowOne) {
  EXPECT_NEAR(radius_of_95(9.0 * Eigen::Matrix2d::Identity()), 3.0 * 2.4477, 1e-3);
  EXPECT_NEAR(radius_of_95(Eigen::Vector2d(4.0, 0.0).asDiagonal()), 2.0 * 1.95996, 1e-3);
  EXPECT_EQ(radius_of_95(Eigen::Matrix2d::Zero()), 0.0);
}

TEST(RadiusOf95, OfWhatIsNoCovarianceIsInfinite) {
  Eigen::Matrix2d broken = Eigen::Matrix2d::Identity();
  broken(0, 1) = broken(1, 0) = 2.0;
  EXPECT_TRUE(std::isinf(radius_of_95(broken)));
  broken(0, 0) = std::nan("");
  EXPECT_TRUE(std::isinf(radius_of_95(broken)));
  EXPECT_EQ(radius_of_95(Eigen::Matrix2d::Zero()), 0.0);
}

TEST(RadiusOf95, HoldsNineteenOfTwentyHoweverNarrowAndTurned) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const double narrow : {0.15, 0.5, 0.85}) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.7).toRotationMatrix();
    const Eigen::Vector2d sigma(2.0, 2.0 * narrow);
    const Eigen::Matrix2d squares = sigma.cwiseAbs2().asDiagonal();
    const double radius = radius_of_95(turn * squares * turn.transpose());
    int inside = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const double x = sigma[0] * normal(random);
      inside += std::hypot(x, sigma[1] * normal(random)) <= radius ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(inside) / kSamples, 0.95, 0.006) << narrow;
  }
}

}  // namespace
}  // namespace chorus

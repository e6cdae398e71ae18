#include "fusion-server/fusion/point_filter.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace chorus::fusion {
namespace {

constexpr Timestamp kPointStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr double kDensity = 4.0;      // [m^2 / s^3]
constexpr double kPointSigma = 0.02;  // [m]
constexpr double kStep = 1.0 / 30;    // [s]

Timestamp at_step(int i) { return kPointStart + from_seconds(kStep * i); }

/// A point driven by white acceleration, as the filter assumes.
struct Wanderer {
  std::mt19937 random{5};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();

  Eigen::Vector3d normal() {
    std::normal_distribution<double> one;
    return {one(random), one(random), one(random)};
  }
  /// Advances by one period in a hundred small steps.
  void go() {
    constexpr int kParts = 100;
    constexpr double kDt = kStep / kParts;
    for (int i = 0; i < kParts; ++i) {
      velocity += std::sqrt(kDensity * kDt) * normal();
      position += kDt * velocity;
    }
  }
};

TEST(PointFilter, StatesTheVarianceThatItsErrorsHave) {
  Wanderer point;
  PointFilter filter(kDensity);
  double now = 0.0;
  double ahead = 0.0;
  constexpr int kPointSteps = 3000;
  for (int i = 0; i < kPointSteps; ++i) {
    const double variance = filter.variance_at(at_step(i));
    const auto predicted = filter.at(at_step(i));
    if (predicted && i > 30) ahead += (*predicted - point.position).squaredNorm() / variance;
    filter.update(at_step(i), point.position + kPointSigma * point.normal(),
                  kPointSigma * kPointSigma);
    if (i > 30)
      now += (*filter.at(at_step(i)) - point.position).squaredNorm() / filter.position_variance();
    point.go();
  }
  EXPECT_NEAR(now / (3.0 * (kPointSteps - 31)), 1.0, 0.1);
  EXPECT_NEAR(ahead / (3.0 * (kPointSteps - 31)), 1.0, 0.1);
}

TEST(PointFilter, GoesOnWithTheSpeedThatItSaw) {
  PointFilter filter(kDensity);
  const Eigen::Vector3d speed(1.0, 0.0, -0.5);
  for (int i = 0; i < 90; ++i) filter.update(at_step(i), kStep * i * speed, 1e-6);
  EXPECT_LT((filter.velocity() - speed).norm(), 0.01);
  EXPECT_LT((*filter.at(at_step(95)) - kStep * 95 * speed).norm(), 0.005);
  EXPECT_GT(filter.variance_at(at_step(95)), filter.variance_at(at_step(90)));
  EXPECT_EQ(*filter.at(at_step(80)), *filter.at(at_step(89))) << "never into the past";
}

TEST(PointFilter, StartsAnewAfterALongAbsence) {
  PointFilter filter(kDensity);
  EXPECT_FALSE(filter.at(kPointStart));
  EXPECT_EQ(filter.variance_at(kPointStart), 0.0);
  for (int i = 0; i < 30; ++i) filter.update(at_step(i), {0.1 * i, 0, 0}, 1e-4);
  const Timestamp later = at_step(29) + PointFilter::kForgotten + std::chrono::milliseconds(1);
  filter.update(later, {0, 2, 0}, 1e-4);
  EXPECT_EQ(*filter.at(later), Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(filter.velocity().norm(), 0.0);
  EXPECT_EQ(filter.position_variance(), 1e-4);
}

}  // namespace
}  // namespace chorus::fusion

#include "common/posture/spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/units.h"
#include "tests/support/builders.h"

namespace chorus::posture {
namespace {

using enum JointId;

/// Bent a little everywhere, so that nothing is at a bound of its measure; errors of a few
/// centimetres, longer in depth.
Skeleton<WorldSpace> doubtful_person() {
  auto body = chorus::testing::standing_person();
  body[ElbowLeft].position += Eigen::Vector3d(0.05, 0.05, 0.2);
  body[WristLeft].position += Eigen::Vector3d(0.0, 0.3, 0.45);
  body[KneeLeft].position += Eigen::Vector3d(0.0, 0.05, 0.25);
  body[ElbowRight].position += Eigen::Vector3d(-0.12, 0.05, 0.1);
  body[WristRight].position += Eigen::Vector3d(-0.1, 0.2, 0.35);
  body[KneeRight].position += Eigen::Vector3d(0.0, 0.02, 0.15);
  for (Joint& joint : body.joints) {
    Eigen::Matrix3d covariance = Eigen::Vector3d(1.0, 0.8, 2.5).asDiagonal();
    covariance(0, 2) = covariance(2, 0) = 0.6;
    joint.covariance = Covariance(covariance * mm(15) * mm(15));
  }
  return body;
}

/// Sample standard deviations of 3000 drawn bodies, known to 1.3 %.
std::array<double, kMeasures> sampled(const Skeleton<WorldSpace>& body) {
  constexpr int kBodies = 3'000;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::array<double, kMeasures> sum{};
  std::array<double, kMeasures> squares{};
  for (int n = 0; n < kBodies; ++n) {
    auto moved = body;
    for (Joint& joint : moved.joints) {
      const Eigen::Matrix3d root = joint.covariance.matrix().llt().matrixL();
      const double x = normal(random), y = normal(random), z = normal(random);
      joint.position += root * Eigen::Vector3d(x, y, z);
    }
    const auto measures = posture_of(moved).measures;
    for (std::size_t m = 0; m < kMeasures; ++m) {
      sum[m] += measures.values[m];
      squares[m] += measures.values[m] * measures.values[m];
    }
  }
  std::array<double, kMeasures> sigma{};
  for (std::size_t m = 0; m < kMeasures; ++m)
    sigma[m] = std::sqrt(squares[m] / kBodies - std::pow(sum[m] / kBodies, 2));
  return sigma;
}

/// Lifts are bounded at zero, where no linear rule holds.
bool bounded(std::size_t m) {
  return m == index_of(Limb::FootLift, Side::Left) || m == index_of(Limb::FootLift, Side::Right) ||
         m == index_of(Limb::KneeHeight, Side::Left) ||
         m == index_of(Limb::KneeHeight, Side::Right);
}

/// Drawn once: both tests compare with the same.
const std::array<double, kMeasures>& sigmas() {
  static const auto kSigmas = sampled(doubtful_person());
  return kSigmas;
}

TEST(SpreadOfMeasures, SigmaPointsAgreeWithSampling) {
  const auto body = doubtful_person();
  const Spread spread = spread_of(body);
  const auto& sigma = sigmas();
  EXPECT_EQ(spread.doubtless, 0u);
  for (std::size_t m = 0; m < kMeasures; ++m) {
    if (std::isnan(sigma[m]) || bounded(m)) continue;
    const auto i = static_cast<Eigen::Index>(m);
    EXPECT_NEAR(std::sqrt(spread.covariance(i, i)) / sigma[m], 1.0, 0.12) << name_of(m);
  }
}

TEST(SpreadOfMeasures, ThirtyTwoDrawsAgreeRoughly) {
  const auto body = doubtful_person();
  const auto& sigma = sigmas();
  const auto drawn = drawn_measures(body);
  double sum = 0.0;
  int count = 0;
  for (std::size_t m = 0; m < kMeasures; ++m) {
    if (std::isnan(sigma[m]) || bounded(m)) continue;
    double mean = 0.0, squares = 0.0;
    for (const auto& draw : drawn.draws) {
      mean += draw.values[m] / kDraws;
      squares += draw.values[m] * draw.values[m] / kDraws;
    }
    sum += std::sqrt(std::max(0.0, squares - mean * mean)) / sigma[m];
    ++count;
  }
  EXPECT_NEAR(sum / count, 1.0, 0.1);
}

TEST(SpreadOfMeasures, NeighboursShareTheJointBetweenThem) {
  const Spread spread = spread_of(doubtful_person());
  const auto raise = static_cast<Eigen::Index>(index_of(Limb::UpperArmElevation, Side::Left));
  const auto elbow = static_cast<Eigen::Index>(index_of(Limb::ElbowFlexion, Side::Left));
  const auto knee = static_cast<Eigen::Index>(index_of(Limb::KneeFlexion, Side::Right));
  EXPECT_GT(std::abs(spread.covariance(raise, elbow)), deg(1) * deg(1));
  EXPECT_NEAR(spread.covariance(raise, knee), 0.0, 1e-12);
}

TEST(SpreadOfMeasures, CountsJointsThatStateNone) {
  auto body = doubtful_person();
  body[ElbowLeft].covariance = {};
  EXPECT_EQ(drawn_measures(body).doubtless, 1u);
  EXPECT_EQ(spread_of(body).doubtless, 1u);
}

TEST(SpreadOfMeasures, UndefinedMeasuresHaveNone) {
  auto body = doubtful_person();
  chorus::testing::hide(body[WristLeft]);
  const Spread spread = spread_of(body);
  const auto elbow = static_cast<Eigen::Index>(index_of(Limb::ElbowFlexion, Side::Left));
  EXPECT_TRUE(std::isnan(spread.covariance(elbow, elbow)));
  const auto knee = static_cast<Eigen::Index>(index_of(Limb::KneeFlexion, Side::Left));
  EXPECT_GT(spread.covariance(knee, knee), 0.0);
}

}  // namespace
}  // namespace chorus::posture

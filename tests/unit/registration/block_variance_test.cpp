#include "fusion-server/registration/block_variance.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace chorus::registration {
namespace {

constexpr std::array<Eigen::Index, 1> kOnly{0};

/// The variance factor that BlockScores finds for the estimated mean of a coloured signal of unit
/// variance with 30 samples a second: each sample has information 1, and its score is its distance
/// from the mean.
double factor_of(double correlation_s, double length_s, const BlockScores::Prior& prior = {}) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const double rho = correlation_s > 0 ? std::exp(-1.0 / (30.0 * correlation_s)) : 0.0;
  const auto count = static_cast<std::size_t>(30.0 * length_s);
  std::vector<double> samples;
  double now = normal(random);
  double mean = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(now);
    mean += now / static_cast<double>(count);
    now = rho * now + std::sqrt(1.0 - rho * rho) * normal(random);
  }
  BlockScores blocks(length_s);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(1, 1);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(1);
  for (std::size_t i = 0; i < count; ++i) {
    information(0, 0) += 1.0;
    score[0] += samples[i] - mean;
    const double time = static_cast<double>(i) / 30.0;
    if (i + 1 < count && blocks.index(time) == blocks.index(time + 1.0 / 30.0)) continue;
    blocks.add(information, score);
    information.setZero();
    score.setZero();
  }
  return blocks.factor(kOnly, prior);
}

TEST(BlockScores, CountWhiteNoiseAsIndependentAndColouredAsFewer) {
  EXPECT_NEAR(factor_of(0.0, 2000), 1.0, 0.2);
  // An AR(1) process has the factor (1 + rho) / (1 - rho), here about 2 * 30 / s * 0.2 s = 12; the
  // blocks are long enough to show most of it.
  EXPECT_NEAR(factor_of(0.2, 2000), 12.0, 2.5);
  EXPECT_GT(factor_of(0.4, 2000), 15.0);
}

TEST(BlockScores, OfShortWalksAreExtrapolatedToWhatTwoSecondsWouldShow) {
  const BlockScores eight(8.0);
  EXPECT_EQ(eight.index(1.99), 0);
  EXPECT_EQ(eight.index(2.01), 1);
  const BlockScores two(2.0);
  EXPECT_EQ(two.index(0.49), 0);
  EXPECT_EQ(two.index(0.51), 1);
}

TEST(BlockScores, WeighWhatIsExpectedAgainstWhatTheyShow) {
  const double own = factor_of(0.2, 100);
  EXPECT_NEAR(factor_of(0.2, 100, {50.0, 1000.0}), 50.0, 0.2);
  const double both = factor_of(0.2, 100, {50.0, 1.0});
  EXPECT_GT(both, own);
  EXPECT_LT(both, 50.0);
}

TEST(BlockScores, WithoutTwoBlocksGoByTheExpectation) {
  BlockScores blocks(10.0);
  EXPECT_EQ(blocks.factor(kOnly, {7.0, 3.0}), 7.0);
  blocks.add(Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Zero(1));
  EXPECT_EQ(blocks.factor(kOnly, {7.0, 3.0}), 7.0);
  blocks.add(Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Zero(1));
  EXPECT_EQ(blocks.factor({}, {7.0, 3.0}), 7.0);
}

/// Scores in one parameter contain no information about another.
TEST(BlockScores, OfSomeParametersLeaveTheOthersOut) {
  BlockScores blocks(10.0);
  for (int i = 0; i < 4; ++i) {
    blocks.add(Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(i % 2 == 0 ? 1.0 : -1.0, 0.0));
  }
  constexpr std::array<Eigen::Index, 1> kOther{1};
  // Four blocks with g_b = +-1 and H_b = 1, so H = 4: v = (4 * 1 / 4) / (1 - 4 (1 / 4)^2).
  EXPECT_NEAR(blocks.factor(kOnly, {}), 1.0 / 0.75, 1e-6);
  EXPECT_LT(blocks.factor(kOther, {}), 1e-3);
}

}  // namespace
}  // namespace chorus::registration

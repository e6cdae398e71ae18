#include "common/comparison/blocks.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace chorus::comparison {
namespace {

/// Noise of first order that lasts for so long [s], 30 values a second.
Series lasting_noise(unsigned seed, double mean, double seconds, double lasts = 1.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> white(0.0, 1.0);
  const double keep = std::exp(-1.0 / (30.0 * lasts));
  Series series;
  double value = white(random);
  for (int i = 0; i < static_cast<int>(30.0 * seconds); ++i) {
    value = keep * value + std::sqrt(1.0 - keep * keep) * white(random);
    series.times.push_back(i / 30.0);
    series.values.push_back(mean + value);
  }
  return series;
}

TEST(Blocks, HoldTheMeanOfNoiseThatLastsAsOftenAsStated) {
  int held = 0;
  constexpr int kDraws = 300;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const Estimate found = mean_of(lasting_noise(seed, 2.0, 120.0), 10.0, 0.9);
    held += std::abs(found.mean - 2.0) <= found.half ? 1 : 0;
  }
  EXPECT_GT(held, 0.84 * kDraws);
  EXPECT_LT(held, 0.95 * kDraws);
}

TEST(Blocks, CountFewerOfThemWhenNoiseOutlastsABlock) {
  int held = 0;
  constexpr int kDraws = 300;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const Estimate found = mean_of(lasting_noise(seed, 2.0, 120.0, 5.0), 5.0, 0.9);
    held += std::abs(found.mean - 2.0) <= found.half ? 1 : 0;
  }
  EXPECT_GT(held, 0.82 * kDraws);  // Blocks taken as independent: below 0.75.
}

TEST(Blocks, FindASlope) {
  Series series = lasting_noise(3, 0.0, 120.0);
  for (std::size_t i = 0; i < series.values.size(); ++i) series.values[i] += 0.1 * series.times[i];
  const Estimate slope = slope_of(series, 5.0, 0.99);
  EXPECT_TRUE(slope.differs(0.0));
  EXPECT_NEAR(slope.mean, 0.1, 0.03);
}

TEST(Blocks, AreTotal) {
  EXPECT_FALSE(mean_of({}, 2.0, 0.99).differs(0.0));
  EXPECT_FALSE(mean_of({{1.0}, {5.0}}, 2.0, 0.99).differs(0.0));
  EXPECT_FALSE(slope_of({{1.0, 1.0, 1.0}, {5.0, 6.0, 7.0}}, 2.0, 0.99).differs(0.0));
  const Estimate same = mean_of({{0, 1, 2, 3}, {0, 0, 0, 0}}, 2.0, 0.99);
  EXPECT_EQ(same.half, 0.0);
  EXPECT_FALSE(same.differs(0.0));
}

}  // namespace
}  // namespace chorus::comparison

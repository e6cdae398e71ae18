// The lower convex hull of delays, extended and shortened in order of time.
#include "common/time/delay_hull.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace chorus {
namespace {

TEST(DelayHull, WithoutPointsHasNoLeast) {
  EXPECT_TRUE(std::isinf(DelayHull{}.least(0.0)));
  DelayHull hull;
  hull.forget_half();
  hull.forget_before(1.0);
  EXPECT_TRUE(hull.empty());
}

TEST(DelayHull, HasTheLeastOfAllPointsAtAnyRate) {
  std::mt19937 random(1);
  std::exponential_distribution<double> delay(1.0);
  DelayHull hull;
  std::vector<DelayHull::Point> all;
  for (int i = 0; i < 500; ++i) {
    all.push_back({0.1 * i, delay(random)});
    hull.add(all.back());
  }
  EXPECT_LT(hull.points().size(), 40u);
  for (const double rate : {-0.3, -0.01, 0.0, 0.02, 0.5}) {
    double least = 1e9;
    for (const auto& [time, value] : all) least = std::min(least, value - rate * time);
    EXPECT_DOUBLE_EQ(hull.least(rate), least) << rate;
  }
}

TEST(DelayHull, OfTwoPointsAtOneTimeKeepsTheLower) {
  DelayHull hull;
  hull.add({1.0, 3.0});
  hull.add({1.0, 2.0});
  hull.add({0.5, 4.0});  // out of order: counts as the last time
  ASSERT_EQ(hull.points().size(), 1u);
  EXPECT_EQ(hull.least(0.0), 2.0);
}

TEST(DelayHull, ForgetsWhatIsOldButNeverTheNewest) {
  DelayHull hull;
  for (int i = 0; i <= 10; ++i) hull.add({1.0 * i, 0.1 * i * i});
  hull.forget_before(4.0);
  EXPECT_EQ(hull.points().front().time, 4.0);
  hull.forget_half();
  EXPECT_EQ(hull.points().front().time, 7.0);
  hull.forget_before(100.0);
  EXPECT_EQ(hull.points().size(), 1u);
}

}  // namespace
}  // namespace chorus

#include "fusion-server/fusion/quality.h"

#include <limits>

#include <gtest/gtest.h>

namespace chorus::fusion {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(DistanceWeight, MatchesEquation1) {
  EXPECT_DOUBLE_EQ(distance_weight(2.5).value(), 1.0);
  EXPECT_DOUBLE_EQ(distance_weight(2.0).value(), 0.75);  // 1 - 0.5^2
  EXPECT_DOUBLE_EQ(distance_weight(3.0).value(), 0.75);
  EXPECT_NEAR(distance_weight(3.4).value(), 0.19, 1e-12);  // 1 - 0.9^2
  EXPECT_DOUBLE_EQ(distance_weight(1.5).value(), 0.0);
  EXPECT_DOUBLE_EQ(distance_weight(3.5).value(), 0.0);
  EXPECT_DOUBLE_EQ(distance_weight(0.0).value(), 0.0);
  EXPECT_DOUBLE_EQ(distance_weight(100.0).value(), 0.0);
}

TEST(FacingWeight, MatchesEquation2) {
  EXPECT_DOUBLE_EQ(facing_weight(0.0).value(), 1.0);
  EXPECT_NEAR(facing_weight(deg(15)).value(), 0.5, 1e-12);
  EXPECT_NEAR(facing_weight(deg(-15)).value(), 0.5, 1e-12);
  EXPECT_NEAR(facing_weight(deg(30)).value(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(facing_weight(deg(31)).value(), 0.0);
  EXPECT_DOUBLE_EQ(facing_weight(deg(180)).value(), 0.0);  // a rear view
}

TEST(BearingWeight, MatchesEquation3) {
  EXPECT_DOUBLE_EQ(bearing_weight(0.0).value(), 1.0);
  EXPECT_NEAR(bearing_weight(deg(-5)).value(), 0.8, 1e-12);
  EXPECT_NEAR(bearing_weight(deg(25)).value(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(bearing_weight(deg(26)).value(), 0.0);
}

TEST(ViewWeight, IsTheProduct) {
  EXPECT_NEAR(view_weight(2.0, deg(15), deg(5)).value(), 0.75 * 0.5 * 0.8, 1e-12);
  EXPECT_DOUBLE_EQ(view_weight(2.5, deg(40), 0).value(), 0.0);
}

TEST(ViewWeight, IsTotal) {
  for (const double odd : {kNan, kInfinity, -kInfinity, 1e308, -1.0}) {
    EXPECT_EQ(view_weight(odd, odd, odd).value(), 0.0);
    EXPECT_EQ(view_weight(odd, 0, 0).value(), 0.0);
  }
  EXPECT_EQ(view_weight(2.5, kNan, 0).value(), 0.0);
  EXPECT_EQ(view_weight(2.5, 0, kNan).value(), 0.0);
}

TEST(ViewWeight, LimitsOfZeroWidthGiveZeroNotNaN) {
  const QualityLimits none{.distance_reach = 0, .max_facing = 0, .max_bearing = 0};
  EXPECT_EQ(view_weight(2.5, 0, 0, none).value(), 0.0);
}

TEST(WeightClamped, StaysInTheUnitInterval) {
  EXPECT_EQ(Weight::clamped(kNan).value(), 0.0);
  EXPECT_EQ(Weight::clamped(-3).value(), 0.0);
  EXPECT_EQ(Weight::clamped(7).value(), 1.0);
  EXPECT_DOUBLE_EQ((Weight::clamped(0.5) * Weight::clamped(0.5)).value(), 0.25);
}

}  // namespace
}  // namespace chorus::fusion

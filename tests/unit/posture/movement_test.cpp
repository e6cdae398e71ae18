#include "common/posture/movement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/posture/spread.h"
#include "tests/support/builders.h"

namespace chorus::posture {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;

TEST(Walking, IsToldFromStandingByTheSpeedOfTheHips) {
  for (const double speed : {0.0, 0.3, 0.5, 1.2}) {
    Walk walk;
    EXPECT_FALSE(walk.speed());
    for (int i = 0; i < 30; ++i)
      walk.add(kStart + i * kFrameInterval,
               points_of(chorus::testing::standing_person({speed * i / 30.0, 0, 0})));
    EXPECT_NEAR(*walk.speed(), speed, 0.01);
    EXPECT_EQ(walk.walking(), speed > kWalkingSpeed);
  }
}

TEST(Walking, ForgetsWhatWasBeforeAGap) {
  Walk walk;
  for (int i = 0; i < 30; ++i)
    walk.add(kStart + i * kFrameInterval, points_of(chorus::testing::standing_person()));
  walk.add(kStart + std::chrono::seconds(3),
           points_of(chorus::testing::standing_person({2, 0, 0})));
  EXPECT_FALSE(walk.speed());
}

TEST(HeldPosture, IsTheMedianOverASecondAndHalfASecondLate) {
  Held held;
  int late = -1;
  for (int i = 0; i < 90; ++i) {
    Measures measures;
    measures[Centre::TrunkFlexion] = i < 45 ? 0.0 : deg(50);
    if (i % 10 == 0)
      measures[Centre::TrunkFlexion] = deg(170);  // an outlier every third of a second
    held.add(kStart + i * kFrameInterval, measures);
    const double median = held.median()[Centre::TrunkFlexion];
    if (i >= 2) {
      EXPECT_LT(median, deg(51));
    }
    if (late < 0 && median > deg(25)) late = i - 45;
  }
  EXPECT_GE(late, 10);
  EXPECT_LE(late, 18);
}

TEST(HeldPosture, IsUnknownWhereMostOfTheSecondIs) {
  Held held;
  for (int i = 0; i < 30; ++i) {
    Measures measures;
    if (i % 3 == 0) measures[Centre::TrunkFlexion] = 0.1;
    measures[Centre::TrunkTwist] = 0.2;
    held.add(kStart + i * kFrameInterval, measures);
  }
  EXPECT_TRUE(std::isnan(held.median()[Centre::TrunkFlexion]));
  EXPECT_EQ(held.median()[Centre::TrunkTwist], 0.2);
}

TEST(SteadyMeasures, DoNotFlickerWithinThreeDegrees) {
  Steady steady;
  Measures measures;
  measures[Centre::TrunkFlexion] = deg(20);
  const double first = steady.follow(measures)[Centre::TrunkFlexion];
  for (const double angle : {21.0, 19.5, 20.4}) {
    measures[Centre::TrunkFlexion] = deg(angle);
    EXPECT_EQ(steady.follow(measures)[Centre::TrunkFlexion], first);
  }
  measures[Centre::TrunkFlexion] = deg(30);
  EXPECT_NEAR(steady.follow(measures)[Centre::TrunkFlexion], deg(28.5), 1e-9);
  measures[Centre::TrunkFlexion] = std::nan("");
  EXPECT_TRUE(std::isnan(steady.follow(measures)[Centre::TrunkFlexion]));
}

}  // namespace
}  // namespace chorus::posture

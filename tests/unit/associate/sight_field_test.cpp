// Where a sensor is expected to see people: as a usual sensor does, then as its record shows.
#include "fusion-server/associate/sight_field.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace chorus::associate {
namespace {

constexpr double kLooks = 0.5;
const Eigen::Vector3d kAhead{0.0, 0.0, 2.5};
const Eigen::Vector3d kAside{2.5, 0.0, 2.5};  // 45 degrees
const Eigen::Vector3d kFarther{0.0, 0.0, 6.0};

TEST(SightField, IsThatOfAUsualDepthCameraAtFirst) {
  const SightField field;
  EXPECT_GT(field.chance(kAhead), kLooks);
  EXPECT_GT(field.chance({1.3, 0.0, 2.5}), kLooks) << "27 degrees";
  EXPECT_GT(field.chance({0.0, 0.0, 4.2}), kLooks);
  EXPECT_LT(field.chance(kAside), kLooks);
  EXPECT_LT(field.chance(kFarther), kLooks);
  EXPECT_LT(field.chance({0.0, 1.5, 2.5}), kLooks) << "under the picture";
  EXPECT_LT(field.chance({0.0, 0.0, 0.6}), kLooks) << "too near";
  EXPECT_EQ(field.chance({0.0, 0.0, -2.0}), 0.0) << "behind";
}

TEST(SightField, GrowsWhereTheSensorSeesPeople) {
  SightField field;
  for (int i = 0; i < 60; ++i) field.learn(kAside, true, 1.0 / 30);
  for (int i = 0; i < 60; ++i) field.learn(kFarther, true, 1.0 / 30);
  EXPECT_GT(field.chance(kAside), kLooks);
  EXPECT_GT(field.chance(kFarther), kLooks);
  EXPECT_LT(field.chance({-2.5, 0.0, 2.5}), kLooks) << "but not on the other side";
}

TEST(SightField, ShrinksBehindAShelfButNotByOnePersonWhoIsLost) {
  SightField field;
  for (int i = 0; i < 300; ++i) field.learn(kAhead, false, 1.0 / 30);
  EXPECT_GT(field.chance(kAhead), kLooks) << "10 s";
  for (int i = 0; i < 1500; ++i) field.learn(kAhead, false, 1.0 / 30);
  EXPECT_LT(field.chance(kAhead), kLooks) << "a minute";
  for (int i = 0; i < 3600; ++i) field.learn(kAhead, true, 1.0 / 30);
  EXPECT_GT(field.chance(kAhead), kLooks) << "the shelf was moved";
}

TEST(SightField, IsTotal) {
  SightField field;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(nan, 0, 1), Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1e300, 0, 1e300)}) {
    field.learn(place, true, 1.0);
    EXPECT_EQ(field.chance(place), 0.0);
  }
  field.learn(kAhead, true, nan);
  EXPECT_TRUE(std::isfinite(field.chance(kAhead)));
}

}  // namespace
}  // namespace chorus::associate

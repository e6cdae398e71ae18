// A heading is followed from a limb that is seen and moves.
#include "fusion-server/worn/heading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::worn {
namespace {

using evaluation::TrackedOrientation;

TrackedOrientation tracked(const Eigen::Quaterniond& limb, bool twist = true) {
  Eigen::Matrix3d covariance = deg(5) * deg(5) * Eigen::Matrix3d::Identity();
  if (!twist) covariance(1, 1) = 10.0;
  return {limb, covariance, twist};
}

const Eigen::Quaterniond kLevel = exp_map(Eigen::Vector3d(0, 0, deg(90)));

TEST(HeadingSight, ALevelLimbShowsItAndAHangingOneOnlyByItsTwist) {
  const Eigen::Quaterniond turn = about_y(deg(10));
  const auto level = heading_sight(tracked(turn * kLevel, false), kLevel, deg(3));
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->off, deg(10), 1e-6);
  EXPECT_NEAR(std::sqrt(level->variance), std::hypot(deg(5), deg(3)), 1e-3);
  EXPECT_FALSE(heading_sight(tracked(turn, false), Eigen::Quaterniond::Identity(), deg(3)));
  const auto hanging = heading_sight(tracked(turn), Eigen::Quaterniond::Identity(), deg(3));
  ASSERT_TRUE(hanging);
  EXPECT_NEAR(hanging->off, deg(10), 1e-6);
}

/// The angle by which the heading is off at the end of a minute with this drift [rad/s].
double left_after_a_minute(double drift, bool moves, Heading& heading) {
  for (int i = 0; i < 1800; ++i) {
    const double t = i / 30.0;
    const Eigen::Quaterniond limb = about_y(moves ? std::sin(2.0 * t) : 0.0) * kLevel;
    const Eigen::Quaterniond predicted = about_y(heading.correction() + drift * t) * limb;
    if (const auto sight = heading_sight(tracked(limb, false), predicted, deg(3)))
      heading.learn(t, predicted, *sight);
  }
  return std::abs(wrap_angle(heading.correction() + drift * 60.0));
}

TEST(Heading, ADriftIsFollowedWhileTheLimbMoves) {
  Heading heading(deg(0.5));
  EXPECT_LT(left_after_a_minute(deg(0.3), true, heading), deg(4));
  EXPECT_LT(std::sqrt(heading.variance(60.0)), deg(4));
}

TEST(Heading, AStillPersonMovesNoHeading) {
  Heading heading(deg(0.5));
  // A lasting error of 8 degrees of what is tracked.
  const TrackedOrientation wrong = tracked(about_y(deg(8)) * kLevel, false);
  for (int i = 0; i < 1800; ++i) {
    const auto sight = heading_sight(wrong, about_y(heading.correction()) * kLevel, deg(3));
    ASSERT_TRUE(sight);
    heading.learn(i / 30.0, kLevel, *sight);
  }
  EXPECT_LT(std::abs(heading.correction()), deg(0.2));
}

TEST(Heading, AHiddenLimbMovesNoHeadingAndIsLessSure) {
  Heading heading(deg(0.5));
  (void)left_after_a_minute(0.0, true, heading);
  const double correction = heading.correction();
  const double before = heading.variance(60.0);
  EXPECT_EQ(heading.correction(), correction);
  EXPECT_NEAR(heading.variance(160.0) - before, 100.0 * deg(0.5) * deg(0.5), 1e-9);
}

}  // namespace
}  // namespace chorus::worn

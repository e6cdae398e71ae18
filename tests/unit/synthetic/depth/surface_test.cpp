#include "common/synthetic/depth/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/synthetic/scene.h"

namespace chorus::synthetic::depth {
namespace {

const Eigen::Vector3d kAhead = Eigen::Vector3d::UnitZ();

TEST(Taper, ABallIsMetAtItsNearSide) {
  const Taper ball{{0, 0, 3}, {0, 0, 3}, 0.5, 0.5};
  EXPECT_NEAR(hit(ball, kAhead).value(), 2.5, 1e-12);
  const Eigen::Vector3d aside = Eigen::Vector3d(0.1, 0, 1).normalized();
  const double closest = 3 * aside.z();
  EXPECT_NEAR(hit(ball, aside).value(), closest - std::sqrt(0.25 - (9 - closest * closest)), 1e-12);
  EXPECT_FALSE(hit(ball, Eigen::Vector3d(0.2, 0, 1).normalized()));
  EXPECT_FALSE(hit(ball, -kAhead)) << "it lies behind";
}

TEST(Taper, AnUprightCylinderIsMetAtItsRadius) {
  const Taper pillar{{0, -1, 2}, {0, 1, 2}, 0.3, 0.3};
  EXPECT_NEAR(hit(pillar, kAhead).value(), 1.7, 1e-12);
  const Eigen::Vector3d up = Eigen::Vector3d(0, 0.3, 1).normalized();
  EXPECT_NEAR(hit(pillar, up).value() * up.z(), 1.7, 1e-12) << "the depth does not change";
  EXPECT_FALSE(hit(pillar, Eigen::Vector3d(0.2, 0, 1).normalized()));
}

TEST(Taper, ItsSurfaceTouchesBothBallsAndNarrowsBetween) {
  const Taper taper{{0, -1, 3}, {0, 1, 3}, 0.4, 0.2};
  // In the plane x = 0 the outline is the common tangent of both circles.
  const double sine = (0.4 - 0.2) / 2.0;
  const double cosine = std::sqrt(1 - sine * sine);
  for (const double y : {-0.8, 0.0, 0.7}) {
    // Point of the tangent at height y: distance from the axis (r_middle - y sine) / cosine.
    const double depth = 3 - (0.3 - y * sine) / cosine;
    const Eigen::Vector3d surface(0, y, depth);
    EXPECT_NEAR(hit(taper, surface.normalized()).value(), surface.norm(), 1e-9) << y;
  }
}

TEST(Taper, OneBallInsideTheOtherIsTheLargerBall) {
  const Taper nested{{0, 0, 3}, {0, 0.05, 3}, 0.5, 0.1};
  EXPECT_NEAR(hit(nested, kAhead).value(), 2.5, 1e-12);
}

TEST(Build, StaysWithinItsSpreadAndIsThePersonsOwn) {
  const BuildSpread spread{0.15, 0.012, 0.25};
  int dark = 0;
  for (std::size_t person = 0; person < 200; ++person) {
    const Build build = draw_build(spread, 1, person);
    for (const double girth : {build.trunk, build.arms, build.legs}) {
      ASSERT_GE(girth, 0.85);
      ASSERT_LE(girth, 1.15);
    }
    ASSERT_LE(build.clothing, 0.012);
    dark += build.dark[static_cast<std::size_t>(Cloth::Legs)];
  }
  EXPECT_NEAR(dark, 50, 25);
  EXPECT_EQ(draw_build(spread, 1, 3).trunk, draw_build(spread, 1, 3).trunk);
  EXPECT_NE(draw_build(spread, 1, 3).trunk, draw_build(spread, 1, 4).trunk);
}

TEST(Surface, ContainsTheJointsAndGrowsWithGirth) {
  WalkerScript script;
  script.path = PathKind::Stand;
  const auto body = to_sensor(Eigen::Isometry3d(Eigen::Translation3d(0, -1, 3)),
                              Walker(script).at(Duration::zero()));
  Build stout;
  stout.trunk = stout.arms = stout.legs = 1.15;
  const auto mean = surface_of(body, Build{});
  const auto thick = surface_of(body, stout);
  ASSERT_EQ(mean.size(), thick.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    EXPECT_NEAR(thick[i].radius_from, 1.15 * mean[i].radius_from, 1e-12);
  }
  for (const Joint& joint : body.joints) {
    const auto first = [&] {
      double nearest = 1e9;
      for (const Taper& taper : mean) {
        nearest = std::min(nearest, hit(taper, joint.position.normalized()).value_or(1e9));
      }
      return nearest;
    }();
    EXPECT_LT(first, joint.position.norm() + 0.03) << "its ray meets the body before the joint";
  }
}

TEST(Surface, AJointThatIsNotThereLeavesItsSegmentsOut) {
  WalkerScript script;
  auto body = to_sensor(Eigen::Isometry3d::Identity(), Walker(script).at(Duration::zero()));
  const std::size_t whole = surface_of(body, Build{}).size();
  body[JointId::ElbowLeft].position.setConstant(std::nan(""));
  EXPECT_EQ(surface_of(body, Build{}).size(), whole - 2) << "upper arm and forearm";
}

}  // namespace
}  // namespace chorus::synthetic::depth

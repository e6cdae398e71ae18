#include "common/positioning/landmark_fit.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/support/matchers.h"
#include "tests/unit/positioning/scenes.h"

namespace chorus::positioning {
namespace {

using chorus::testing::VectorNear;
using testing::camera_at;
using testing::rays_of;

const Eigen::Isometry3d kCamera = camera_at({0, 1.6, 4.5}, {0, 1, 0});
const Eigen::Isometry3d kOther = camera_at({4.0, 1.4, 0.5}, {0, 1, 0});

struct Scene {
  Skeleton<WorldSpace> body = chorus::testing::standing_person({0.4, 0, -0.3}, 0.7);
  suit::SuitPose pose = suit::pose_of(chorus::testing::standing_person(), Duration{0});
  Eigen::Vector3d place = body[JointId::SpineBase].position;
};

TEST(LandmarkFit, PutsThePoseOntoExactRays) {
  Scene scene;
  std::mt19937 random(1);
  const std::array rays{SeenRays{kCamera, rays_of(scene.body, kCamera, 0.0, random)}};
  const auto fit = fit_landmarks(rays, scene.pose, {0.5, 0.3});
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->place, VectorNear(scene.place, 0.02));
  EXPECT_NEAR(fit->heading, 0.7, deg(3.0));
  EXPECT_LT(fit->misfit, 0.2);
}

TEST(LandmarkFit, FindsTheHeadingOfASuitThatKnowsNone) {
  Scene scene;
  std::mt19937 random(2);
  scene.body = chorus::testing::t_pose_person({0.4, 0, -0.3}, -2.5);
  scene.pose = suit::pose_of(chorus::testing::t_pose_person(), Duration{0});
  const std::array rays{SeenRays{kCamera, rays_of(scene.body, kCamera, 0.002, random)}};
  const auto fit = fit_any_heading(rays, scene.pose);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(wrap_angle(fit->heading + 2.5), 0.0, deg(6.0));
}

/// Over many draws: one camera is worst along its line of sight; a second one helps most there.
TEST(LandmarkFit, OfTwoCamerasIsMuchBetterThanOfOne) {
  Scene scene;
  double one = 0.0;
  double two = 0.0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    std::mt19937 random(seed);
    const std::array rays{SeenRays{kCamera, rays_of(scene.body, kCamera, 0.008, random)},
                          SeenRays{kOther, rays_of(scene.body, kOther, 0.008, random)}};
    const auto single = fit_landmarks(std::span(rays).first(1), scene.pose, {0.7, 0.1});
    const auto both = fit_landmarks(rays, scene.pose, {0.7, 0.1});
    ASSERT_TRUE(single && both);
    one += (single->place - scene.place).squaredNorm();
    two += (both->place - scene.place).squaredNorm();
  }
  EXPECT_LT(std::sqrt(two / one), 0.5);
}

TEST(LandmarkFit, AnotherPoseMisfits) {
  Scene scene;
  std::mt19937 random(3);
  const std::array rays{
      SeenRays{kCamera, rays_of(chorus::testing::t_pose_person(), kCamera, 0.0, random)}};
  const auto fit = fit_any_heading(rays, scene.pose);
  EXPECT_TRUE(!fit || fit->misfit > 1.5);
}

TEST(LandmarkFit, NeedsRaysAndAPose) {
  Scene scene;
  std::mt19937 random(4);
  EXPECT_FALSE(fit_landmarks({}, scene.pose, {}));
  const std::array rays{SeenRays{kCamera, rays_of(scene.body, kCamera, 0.0, random)}};
  EXPECT_FALSE(fit_landmarks(rays, {}, {}));
  std::array behind{rays[0]};
  for (Joint& joint : behind[0].rays.joints) joint.position = -joint.position;
  EXPECT_FALSE(fit_landmarks(behind, scene.pose, {}));
  std::array nothing{rays[0]};
  for (Joint& joint : nothing[0].rays.joints) joint.position.setConstant(std::nan(""));
  EXPECT_FALSE(fit_landmarks(nothing, scene.pose, {}));
}

}  // namespace
}  // namespace chorus::positioning

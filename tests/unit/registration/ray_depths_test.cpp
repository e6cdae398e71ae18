#include "fusion-server/registration/ray_depths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/geometry/error_radius.h"
#include "fusion-server/registration/guessed_depth.h"
#include "tests/unit/registration/ray_walk.h"

namespace chorus::registration {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

double apart(int a, int b) {
  return (ray_place(a).translation() - ray_place(b).translation()).norm();
}

RegistrationConfig measured(int a, int b) {
  RegistrationConfig config;
  config.known_distances = {{sensor(a), sensor(b), apart(a, b)}};
  return config;
}

/// Of a sensor's place, seen from the master's.
PlaceError error_of(const Registration& found, int number) {
  int master = 0;
  while (sensor(master) != found.master) ++master;
  const Eigen::Isometry3d relative = found.sensors.at(found.master).world_from_sensor.inverse() *
                                     found.sensors.at(sensor(number)).world_from_sensor;
  return difference(relative, ray_place(master).inverse() * ray_place(number));
}

TEST(RayDepths, RegisterCamerasThatSendDirectionsAloneWithOneDistance) {
  const Registration found =
      solve(ray_walk(4, {.length = 20}, kRayNoise), kWalkStart, measured(0, 2));
  ASSERT_EQ(found.sensors.size(), 4u) << (found.reasons.empty() ? "" : found.reasons.front());
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(error_of(found, i).position, mm(60)) << i;
    EXPECT_LT(error_of(found, i).angle, deg(0.5)) << i;
    EXPECT_EQ(found.sensors.at(sensor(i)).scale, 1.0) << "rays are not scaled";
    EXPECT_GT(found.sensors.at(sensor(i)).world_from_sensor.translation().y(), 1.3)
        << "the floor is below the feet of the person";
  }
  EXPECT_EQ(found.verdict, Verdict::Good);
  EXPECT_THAT(found.reasons, ElementsAre(HasSubstr("no sensor measures the floor")))
      << "told once, and no reason against any camera";
  for (const auto& [id, place] : found.sensors) {
    EXPECT_TRUE(found.verdicts.at(id).reasons.empty()) << id.str();
    EXPECT_LT(std::sqrt(place.covariance(0, 0)), deg(1)) << "the tilt of all is not in each";
    EXPECT_LT(radius_on_floor(place.covariance), 0.15);
  }
}

TEST(RayDepths, OfAWalkWithoutALengthAreThoseOfAPersonOfTypicalSize) {
  const std::vector<WalkTrack> given = with_ray_depths(ray_walk(3, {.length = 10}), {});
  for (const WalkTrack& track : given) {
    EXPECT_TRUE(track.directions);
    EXPECT_TRUE(guesses_depth(track));
    EXPECT_TRUE(track.objection.empty());
  }
  const Joint& neck = given[0].frames[60].bodies[0].skeleton[JointId::Neck];
  ASSERT_TRUE(neck.seen());
  const auto exact = watch(0, ray_place(0), {.length = 10, .noise = 0.0});
  const double scale =
      neck.position.norm() / exact.frames[60].bodies[0].skeleton[JointId::Neck].position.norm();
  EXPECT_NEAR(scale, 1.70 * 0.779 / 1.3004, 0.01)
      << "person_at() has 1.30 m from ankle to shoulder";
  const Registration found = solve(ray_walk(3, {.length = 10}), kWalkStart, {});
  EXPECT_EQ(found.verdict, Verdict::Provisional);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("scale unknown")));
}

struct Degenerate {
  const char* name;
  Path path;
  const char* reason;
};

class DegenerateWalk : public testing::TestWithParam<Degenerate> {};

TEST_P(DegenerateWalk, IsRefusedByName) {
  const auto walk = ray_walk(3, {.path = GetParam().path, .length = 12}, 0.004);
  const Registration found = solve(walk, kWalkStart, measured(0, 2));
  EXPECT_EQ(found.verdict, Verdict::Refused);
  EXPECT_TRUE(found.sensors.empty());
  EXPECT_THAT(found.reasons, ElementsAre(HasSubstr(GetParam().reason)));
  EXPECT_THAT(found.verdicts.at(sensor(1)).reasons, ElementsAre(HasSubstr("walk ")));
}

INSTANTIATE_TEST_SUITE_P(All, DegenerateWalk,
                         testing::Values(Degenerate{"Spot", on_the_spot, "stayed on the spot"},
                                         Degenerate{"Line", on_one_line, "the walk was one line"}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(RayDepths, OneCameraAloneIsToldSo) {
  const Registration found = solve(ray_walk(1, {.length = 6}), kWalkStart, {});
  EXPECT_EQ(found.verdict, Verdict::Refused);
  EXPECT_THAT(found.reasons, ElementsAre(HasSubstr("one camera alone cannot place")));
}

TEST(RayDepths, ACameraStandsBesideSensorsThatMeasureDepth) {
  std::vector<WalkTrack> walk;
  for (int i = 0; i < 2; ++i) walk.push_back(watch(i, ray_place(i), {.length = 20}));
  walk.push_back(as_rays(watch(2, ray_place(2), {.length = 20, .noise = 0.0}), kRayNoise));
  const Registration found = solve(walk, kWalkStart, {});
  ASSERT_EQ(found.sensors.size(), 3u);
  EXPECT_LT(error_of(found, 2).position, mm(30));
  EXPECT_LT(error_of(found, 2).angle, deg(0.5));
  EXPECT_EQ(found.sensors.at(sensor(2)).scale, 1.0);
}

TEST(RayDepths, ACameraBesideOthersThatFollowsSomebodyElseIsRefusedByName) {
  std::vector<WalkTrack> walk;
  for (int i = 0; i < 2; ++i) walk.push_back(watch(i, ray_place(i), {.length = 10}));
  walk.push_back(as_rays(watch(2, ray_place(2), {.path = elsewhere, .length = 10, .noise = 0.0})));
  const Registration found = solve(walk, kWalkStart, {});
  EXPECT_EQ(found.sensors.size(), 2u);
  EXPECT_THAT(found.verdicts.at(sensor(2)).reasons,
              ElementsAre(HasSubstr("fits no sensor that measures depth")));
}

TEST(RayDepths, OfPointsAreNotTouched) {
  const std::vector<WalkTrack> walk{watch(0, ray_place(0), {.length = 1})};
  const std::vector<WalkTrack> same = with_ray_depths(walk, {});
  EXPECT_FALSE(same[0].directions);
  EXPECT_EQ(same[0].frames[3].bodies[0].skeleton[JointId::Head].position,
            walk[0].frames[3].bodies[0].skeleton[JointId::Head].position);
}

}  // namespace
}  // namespace chorus::registration

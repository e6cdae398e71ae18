#include "fusion-server/registration/ray_depths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "common/geometry/error_radius.h"
#include "fusion-server/registration/guessed_depth.h"
#include "fusion-server/registration/ray_extent.h"
#include "fusion-server/registration/ray_places.h"
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
      solve(ray_walk(3, {.length = 20}, kRayNoise), kWalkStart, measured(0, 2));
  ASSERT_EQ(found.sensors.size(), 3u) << (found.reasons.empty() ? "" : found.reasons.front());
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(error_of(found, i).position, mm(30)) << i;
    EXPECT_LT(error_of(found, i).angle, deg(0.5)) << i;
    EXPECT_EQ(found.sensors.at(sensor(i)).scale, 1.0) << "rays are not scaled";
    EXPECT_GT(found.sensors.at(sensor(i)).world_from_sensor.translation().y(), 1.3)
        << "the floor is below the feet of the person";
  }
  EXPECT_THAT(found.reasons, Contains(HasSubstr("no sensor measures the floor"))) << "told once";
  EXPECT_EQ(found.verdict, Verdict::Provisional) << "never Good by rays alone";
  EXPECT_THAT(found.reasons, Contains(HasSubstr("once somebody has accepted them")));
  for (const auto& [id, place] : found.sensors) {
    EXPECT_THAT(found.verdicts.at(id).reasons, Contains(HasSubstr("lens to lens"))) << id.str();
    EXPECT_TRUE(found.verdicts.at(id).unconfirmed);
    EXPECT_LT(std::sqrt(place.covariance(0, 0)), deg(1)) << "the tilt of all is not in each";
    EXPECT_LT(radius_on_floor(place.covariance), 0.25);
  }
}

/// A rig of four cameras whose places are as ray_place() says, all of them by rays.
std::vector<WalkTrack> four_by_rays() {
  std::vector<WalkTrack> walk;
  for (int i = 0; i < 4; ++i) walk.push_back({sensor(i), {}, true});
  return walk;
}

Registration placed_four() {
  Registration found;
  found.verdict = Verdict::Good;
  found.master = sensor(0);
  for (int i = 0; i < 4; ++i) {
    found.sensors[sensor(i)].world_from_sensor = ray_place(i);
    found.verdicts[sensor(i)].verdict = Verdict::Good;
  }
  return found;
}

TEST(RayPlaces, AreNeverGoodNorUsedUnasked) {
  RegistrationConfig config = measured(0, 2);
  config.known_distances.push_back({sensor(1), sensor(3), apart(1, 3)});
  std::vector<WalkTrack> walk = four_by_rays();
  walk[3].directions = false;
  const Registration found = with_ray_doubts(placed_four(), walk, config);
  EXPECT_EQ(found.verdict, Verdict::Provisional);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(found.verdicts.at(sensor(i)).verdict, Verdict::Provisional);
    EXPECT_TRUE(found.verdicts.at(sensor(i)).unconfirmed) << "however many distances agree";
  }
  EXPECT_EQ(found.verdicts.at(sensor(3)).verdict, Verdict::Good) << "it measures depth";
  EXPECT_FALSE(found.verdicts.at(sensor(3)).unconfirmed);
}

TEST(RayPlaces, NameADistanceThatWasNotMeasuredYet) {
  RegistrationConfig config = measured(0, 1);
  config.cameras_alone = true;
  const Registration found = with_ray_doubts(placed_four(), four_by_rays(), config);
  EXPECT_THAT(
      found.verdicts.at(sensor(0)).reasons.front(),
      HasSubstr(fmt::format("whether {} is {:.2f} m from it", sensor(3).str(), apart(0, 3))));
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

/// Where the joints of somebody who follows this path are.
std::vector<RayPoint> points_on(const Path& path) {
  std::vector<RayPoint> points;
  for (double t = 0.0; t < 12.0; t += 0.2) {
    const auto person = person_at(path(t), 0.0, t);
    for (const JointId joint : {JointId::HipLeft, JointId::HipRight})
      points.push_back({t, index_of(joint), {}, person[joint].position});
  }
  return points;
}

TEST(RayExtent, RefusesWalksThatPlaceNoCamerasByName) {
  EXPECT_THAT(wide_enough(points_on(on_the_spot)).error().message, HasSubstr("stayed on the spot"));
  EXPECT_THAT(wide_enough(points_on(on_one_line)).error().message,
              HasSubstr("the walk was one line"));
  EXPECT_TRUE(wide_enough(points_on(another_walk)));
  EXPECT_FALSE(wide_enough({}));
}

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
  EXPECT_TRUE(found.verdicts.at(sensor(2)).unconfirmed);
  EXPECT_FALSE(found.verdicts.at(sensor(0)).unconfirmed);
}

TEST(RayDepths, ACameraBesideOthersThatFollowsSomebodyElseIsRefusedByName) {
  std::vector<WalkTrack> walk;
  for (int i = 0; i < 2; ++i) walk.push_back(watch(i, ray_place(i), {.length = 10}));
  walk.push_back(
      as_rays(watch(2, ray_place(2), {.path = another_walk, .length = 10, .noise = 0.0})));
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

#include "fusion-server/registration/ray_points.h"

#include <gtest/gtest.h>

#include "tests/unit/registration/ray_walk.h"

namespace chorus::registration {
namespace {

const Eigen::Vector3d kJoint(0.3, 1.1, 0.2);

RayPoint seen_by(std::initializer_list<int> cameras, RayPlaces& places) {
  RayPoint point;
  for (const int camera : cameras) {
    const auto index = static_cast<std::size_t>(camera);
    places[index] = ray_place(camera);
    point.seen.push_back({index, (places[index].inverse() * kJoint).normalized(), 0.01, false});
  }
  return point;
}

TEST(RaysMeet, WhereTheJointIs) {
  RayPlaces places;
  RayPoint point = seen_by({0, 1}, places);
  meet(point, places, 4.0);
  ASSERT_TRUE(point.x);
  EXPECT_LT((*point.x - kJoint).norm(), 1e-9);
  EXPECT_TRUE(point.seen[0].counted && point.seen[1].counted);
}

TEST(RaysMeet, WithoutTheOneThatIsWrong) {
  RayPlaces places;
  RayPoint point = seen_by({0, 1, 2, 3}, places);
  point.seen[2].ray = about_y(0.2) * point.seen[2].ray;
  meet(point, places, 4.0);
  ASSERT_TRUE(point.x);
  EXPECT_LT((*point.x - kJoint).norm(), 1e-9);
  EXPECT_FALSE(point.seen[2].counted);
  EXPECT_TRUE(point.seen[3].counted);
}

TEST(RaysMeet, NowhereIfTwoDisagreeOrAreParallelOrPointAway) {
  RayPlaces places;
  RayPoint apart = seen_by({0, 1}, places);
  // A turn within the plane of both would only move where they meet.
  apart.seen[1].ray = (apart.seen[1].ray + Eigen::Vector3d(0.0, 0.3, 0.0)).normalized();
  meet(apart, places, 4.0);
  EXPECT_FALSE(apart.x);

  RayPoint parallel = seen_by({0}, places);
  places[5] = places[0];
  places[5].translation() += places[0].linear() * Eigen::Vector3d(0.05, 0, 0);
  parallel.seen.push_back({5, (places[5].inverse() * kJoint).normalized(), 0.01, false});
  meet(parallel, places, 4.0);
  EXPECT_FALSE(parallel.x) << "five centimetres apart, at four metres";

  RayPoint away = seen_by({0, 1}, places);
  for (RaySight& sight : away.seen) sight.ray *= -1.0;
  meet(away, places, 4.0);
  EXPECT_FALSE(away.x);
}

TEST(RaysMeet, OnlyRaysOfCamerasWithAPlaceAndNeverOneAlone) {
  RayPlaces places;
  RayPoint point = seen_by({0, 1}, places);
  places.erase(1);
  meet(point, places, 4.0);
  EXPECT_FALSE(point.x);
  RayPoint nobody;
  meet(nobody, places, 4.0);
  EXPECT_FALSE(nobody.x);
}

TEST(RayPoints, AreJointsThatTwoCamerasSawAtOneInstant) {
  const auto walk = ray_walk(3, {.length = 4});
  const auto points = ray_points(ray_trails(walk), std::chrono::milliseconds(60));
  ASSERT_GT(points.size(), 500u);
  double last = 0.0;
  for (const RayPoint& point : points) {
    EXPECT_GE(point.seen.size(), 2u);
    EXPECT_GE(point.time, last);
    last = point.time;
    for (const RaySight& sight : point.seen) EXPECT_NEAR(sight.ray.norm(), 1.0, 1e-12);
  }
  EXPECT_TRUE(ray_points({}, std::chrono::milliseconds(60)).empty());
  EXPECT_TRUE(ray_points(ray_trails({walk[0]}), std::chrono::milliseconds(60)).empty());
}

TEST(RayPoints, SensorsThatSendOnlyRaysAreTold) {
  const WalkTrack track = watch(0, ray_place(0), {.length = 1});
  EXPECT_FALSE(sends_rays_alone(track));
  EXPECT_TRUE(sends_rays_alone(as_rays(track)));
  EXPECT_FALSE(sends_rays_alone({sensor(0), {}}));
  WalkTrack mixed = as_rays(track);
  mixed.frames.back() = track.frames.back();
  EXPECT_FALSE(sends_rays_alone(mixed));
}

}  // namespace
}  // namespace chorus::registration

#include "fusion-server/registration/ray_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/registration/ray_walk.h"

namespace chorus::registration {
namespace {

using testing::HasSubstr;

constexpr Duration kGap = std::chrono::milliseconds(60);
Result<RayRig> solved(const std::vector<WalkTrack>& walk) {
  return rig_of(ray_points(ray_trails(walk), kGap), names_of(walk));
}

/// The largest error of a place relative to the first, the rig made as large as it is in truth.
PlaceError worst_of(const RayRig& rig, int cameras) {
  const Eigen::Isometry3d first = rig.places.at(0).inverse();
  const auto true_place = [](int i) { return ray_place(0).inverse() * ray_place(i); };
  double length = 0.0;
  double true_length = 0.0;
  for (int i = 1; i < cameras; ++i) {
    length += (first * rig.places.at(static_cast<std::size_t>(i))).translation().norm();
    true_length += true_place(i).translation().norm();
  }
  PlaceError worst;
  for (int i = 1; i < cameras; ++i) {
    Eigen::Isometry3d place = first * rig.places.at(static_cast<std::size_t>(i));
    place.translation() *= true_length / length;
    const PlaceError off = difference(place, true_place(i));
    worst.position = std::max(worst.position, off.position);
    worst.angle = std::max(worst.angle, off.angle);
  }
  return worst;
}

TEST(RayRig, IsExactWithoutNoise) {
  const auto rig = solved(ray_walk(4, {.length = 8}));
  ASSERT_TRUE(rig) << rig.error().message;
  ASSERT_EQ(rig->places.size(), 4u);
  const PlaceError off = worst_of(*rig, 4);
  EXPECT_LT(off.position, mm(6)) << "rays are interpolated between frames";
  EXPECT_LT(off.angle, deg(0.1));
}

TEST(RayRig, LeavesACameraOutThatFollowsSomebodyElse) {
  std::vector<WalkTrack> walk = ray_walk(3, {.length = 8});
  walk[2] = as_rays(watch(2, ray_place(2), {.path = another_walk, .length = 8, .noise = 0.0}));
  const auto rig = solved(walk);
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->places.size(), 2u);
  ASSERT_TRUE(rig->refused.contains(2));
  EXPECT_THAT(rig->refused.at(2), HasSubstr("sensor s2 contradicts the other cameras"));
}

TEST(RayRig, NeedsCamerasThatStandApart) {
  const Eigen::Isometry3d place = ray_place(0);
  Eigen::Isometry3d turned = place;
  turned.linear() = about_y(0.2) * place.linear();
  const WalkSpec spec{.length = 10, .noise = 0.0};
  const auto rig =
      solved({as_rays(watch(0, place, spec), 0.002, 1), as_rays(watch(1, turned, spec), 0.002, 2)});
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().message, HasSubstr("look from one place, or are only turned"));
}

TEST(RayRig, NeedsCamerasThatSawThePersonTogether) {
  std::vector<WalkTrack> walk = ray_walk(2, {.length = 12});
  std::erase_if(walk[0].frames,
                [](const SensorFrame& f) { return f.captured > kWalkStart + from_seconds(5); });
  std::erase_if(walk[1].frames,
                [](const SensorFrame& f) { return f.captured < kWalkStart + from_seconds(6); });
  const auto rig = solved(walk);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, ErrorCode::NotFound);
  EXPECT_THAT(rig.error().message, HasSubstr("(s0, s1) saw the person together for long enough"));
  EXPECT_FALSE(solved({}));
}

}  // namespace
}  // namespace chorus::registration

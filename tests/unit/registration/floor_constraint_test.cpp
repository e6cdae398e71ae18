#include "fusion-server/registration/floor_constraint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion-server/registration/impossible_place.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const Eigen::Isometry3d kPlace = ring_place(deg(30));

TEST(FloorOf, IsTheMedianSoThatOneBadFrameDoesNoHarm) {
  WalkTrack walk = watch(1, kPlace, {.length = 2});
  walk.frames[3].floor = FloorPlane{Eigen::Vector3d::UnitX(), 9.0};
  walk.frames[4].floor = FloorPlane{{std::nan(""), 0, 0}, std::nan("")};
  const WalkFloor sight = floor_of(walk);
  ASSERT_TRUE(sight.floor) << sight.objection;
  EXPECT_NEAR(sight.floor->offset, 1.8, 1e-6);
  EXPECT_NEAR(sight.floor->normal.y(), std::cos(deg(15)), 1e-6);
  EXPECT_THAT(sight.objection, IsEmpty());
}

TEST(FloorOf, SaysWhatIsWrong) {
  const auto with = [](const FloorPlane& in_world) {
    return floor_of(watch(1, kPlace, {.length = 2, .floor_in_world = in_world})).objection;
  };
  EXPECT_THAT(with({Eigen::Vector3d::UnitY(), -0.8}), HasSubstr("above the person's feet"));
  EXPECT_THAT(with({Eigen::Vector3d::UnitY(), 1.5}), HasSubstr("below the person's feet"));
  EXPECT_THAT(with({-Eigen::Vector3d::UnitY(), 0.0}), HasSubstr("does not point up"));
  EXPECT_THAT(with({Eigen::Vector3d::UnitY(), -3.0}), HasSubstr("not below it"));
  EXPECT_EQ(floor_of({sensor(1), {}}).objection, "it reports no floor plane");
}

TEST(FloorOf, IsTakenHoweverTheSensorHangs) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d down = Eigen::Isometry3d::Identity();  // from the ceiling, and a little beyond
  down.linear() = Eigen::AngleAxisd(deg(92), x).toRotationMatrix();
  down.translation() = Eigen::Vector3d(0, 3.2, 0);
  const Eigen::Isometry3d portrait = kPlace * Eigen::AngleAxisd(deg(90), z);
  const Eigen::Isometry3d head_down = kPlace * Eigen::AngleAxisd(deg(180), z);
  for (const Eigen::Isometry3d& place : {down, portrait, head_down}) {
    const WalkTrack walk = watch(1, place, {.length = 2});
    const WalkFloor sight = floor_of(walk);
    ASSERT_TRUE(sight.floor) << sight.objection;
    EXPECT_NEAR(sight.floor->offset, place.translation().y(), 1e-6);
    EXPECT_EQ(impossible(place, upright(walk), false), std::nullopt);
  }
  const WalkTrack wall = watch(1, kPlace, {.length = 2, .floor_in_world = FloorPlane{z, 3.5}});
  EXPECT_THAT(floor_of(wall).objection, HasSubstr("does not point up"));
}

TEST(Impossible, IsAPlaceFromWhichPeopleStandOnTheirHeads) {
  const auto up = upright(watch(1, kPlace, {.length = 2}));
  EXPECT_EQ(impossible(kPlace, up, false), std::nullopt);
  const Eigen::Isometry3d turned = kPlace * Eigen::AngleAxisd(deg(180), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(impossible(turned, up, false), "would see people head down");
}

TEST(FloorFromBody, StandsUnderTheFeetOfAnUprightPerson) {
  const auto floor = floor_from_body(watch(1, kPlace, {.floor_in_world = std::nullopt}));
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->offset, 1.8, 0.03);
  EXPECT_NEAR(std::acos(floor->normal.dot(kPlace.linear().row(1).transpose())), 0.0, deg(0.5));
  EXPECT_FALSE(floor_from_body({sensor(1), {}}));
}

/// A camera that guesses depth sees everybody lean away from it by `lean` [rad].
WalkTrack leaning(WalkTrack walk, double lean) {
  for (SensorFrame& frame : walk.frames) {
    for (BodyFrame& body : frame.bodies) {
      const Eigen::Vector3d base = body.skeleton[JointId::SpineBase].position;
      const auto turn = Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitX());
      for (Joint& joint : body.skeleton.joints)
        joint.position = base + turn * (joint.position - base);
    }
  }
  return walk;
}

TEST(FloorFromBodies, CamerasOnOppositeSidesLeanThemApart) {
  const Eigen::Isometry3d opposite = ring_place(deg(210));
  const WalkTrack one = leaning(watch(1, kPlace, {.floor_in_world = std::nullopt}), deg(20));
  const WalkTrack other = leaning(watch(2, opposite, {.floor_in_world = std::nullopt}), deg(20));
  const auto alone = floor_from_bodies({{&one, kPlace}});
  const auto both = floor_from_bodies({{&one, kPlace}, {&other, opposite}});
  ASSERT_TRUE(alone && both);
  EXPECT_GT(std::acos(alone->normal.y()), deg(10));
  EXPECT_LT(std::acos(both->normal.y()), deg(3));
  EXPECT_NEAR(both->offset, 0.0, 0.3);  // leaning feet are lower
  EXPECT_FALSE(floor_from_bodies({}));
}

/// Tilted floors cross where the person stands, however short the walk is.
TEST(FloorFromBodies, OfAnInstantIsAtTheFeetToo) {
  const Eigen::Isometry3d opposite = ring_place(deg(210));
  const WalkSpec instant{.length = 0.02, .noise = 0.0, .floor_in_world = std::nullopt};
  const WalkTrack one = leaning(watch(0, kPlace, instant), deg(20));
  const WalkTrack other = leaning(watch(0, opposite, instant), deg(20));
  ASSERT_EQ(one.frames.size(), 1u);
  const auto floor = floor_from_bodies({{&one, kPlace}, {&other, opposite}});
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->offset, 0.0, 0.1);
}

/// A floor tilted by `degrees` about z, correct right below a sensor at x.
PlacedFloor tilted_floor(double degrees, double x, double height_error = 0.0) {
  const double angle = deg(degrees);
  const Eigen::Vector3d normal(std::sin(angle), std::cos(angle), 0);
  const Eigen::Vector3d eye(x, 1.5, 0);
  return {{normal, 1.5 + height_error - normal.dot(eye)}, eye};
}

TEST(CommonFloor, AveragesTiltAndHeight) {
  const FloorPlane floor =
      common_floor({tilted_floor(0.3, 0), tilted_floor(-0.3, 6), tilted_floor(0.0, 3, 0.006)});
  EXPECT_NEAR(std::acos(floor.normal.y()), 0.0, deg(0.01));
  EXPECT_NEAR(floor.offset, 0.002, 1e-4);
}

TEST(CommonFloor, LeavesOutWhatIsFarOffTheOthers) {
  const FloorPlane floor = common_floor(
      {tilted_floor(0.1, 0), tilted_floor(-0.1, 3), tilted_floor(8, 6, 0.4), tilted_floor(0, 1)});
  EXPECT_NEAR(std::acos(floor.normal.y()), 0.0, deg(0.05));
  EXPECT_NEAR(floor.offset, 0.0, 0.005);
}

TEST(CommonFloor, OfOneIsItself) {
  const PlacedFloor only = tilted_floor(2, 1);
  EXPECT_TRUE(common_floor({only}).normal.isApprox(only.floor.normal, 1e-12));
  EXPECT_NEAR(common_floor({only}).offset, only.floor.offset, 1e-12);
}

TEST(WorldFromMaster, PutsTheFloorAtZeroAndTheViewAlongZ) {
  const Eigen::Isometry3d rolled = kPlace * Eigen::AngleAxisd(deg(7), Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d world = world_from_master(plane_in_sensor({}, rolled));
  EXPECT_LT((world.translation() - Eigen::Vector3d(0, 1.8, 0)).norm(), 1e-9);
  const Eigen::Vector3d view = world.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(view.x(), 0.0, 1e-9);
  EXPECT_GT(view.z(), 0.9);
  const Eigen::Vector3d down_view(0, 0, -1);  // straight down: no direction on the floor
  EXPECT_TRUE(world_from_master({down_view, 2.5}).matrix().allFinite());
}

}  // namespace
}  // namespace chorus::registration

#include "common/synthetic/depth/body_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/body/facing.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic::depth {
namespace {

using enum JointId;

constexpr TimeOfFlight kQuiet{0, 0, 0, 0, 0, 0.5, 4.5};

/// A room in front of a level sensor, 1.2 m above the floor; all of it in sensor space.
struct Room {
  View view;
  BodyTracker tracker{DepthCamera{}};

  Room() { view.floor = {Eigen::Vector3d::UnitY(), 1.2}; }
  void enter(const Skeleton<SensorSpace>& body) {
    for (const Taper& taper : surface_of(body, Build{})) view.people.push_back(taper);
  }
  std::vector<TrackedBody> look(int frames = 1) {
    std::vector<TrackedBody> bodies;
    const DepthImage image = measure(render(view, {}), kQuiet, Draw{1});
    for (int i = 0; i < frames; ++i) bodies = tracker.look(image, view.floor);
    return bodies;
  }
};

/// A person standing at (x, z) in front of the sensor, turned by `yaw` from facing it.
Skeleton<SensorSpace> somebody(double x, double z, double yaw = 0.0) {
  WalkerScript script;
  script.path = PathKind::Stand;
  const Walker walker(script);
  const auto body = walker.at(Duration::zero());
  const double heading = walker.path().at(Duration::zero()).heading;
  Eigen::Isometry3d sensor_from_world = Eigen::Isometry3d::Identity();
  sensor_from_world.linear() = about_y(std::numbers::pi + yaw - heading).toRotationMatrix();
  sensor_from_world.translation() = Eigen::Vector3d(x, -1.2, z);
  return to_sensor(sensor_from_world, body);
}

double median_error(const Skeleton<SensorSpace>& body, const Skeleton<SensorSpace>& exact,
                    bool mirrored = false) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i].seen()) continue;
    const auto id = static_cast<JointId>(i);
    errors.push_back((body[id].position - exact[mirrored ? mirror(id) : id].position).norm());
  }
  if (errors.empty()) return 1e9;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

TEST(BodyTracker, SomebodyWhoFacesTheSensorIsFoundWhereTheyStand) {
  for (const double z : {2.2, 2.8, 3.5}) {  // nearer, the feet are out of view
    Room room;
    room.enter(somebody(0.2, z));
    const auto bodies = room.look(10);
    ASSERT_EQ(bodies.size(), 1u) << z;
    EXPECT_LT(to_mm(median_error(bodies[0].skeleton, somebody(0.2, z))), 60) << z;
  }
}

TEST(BodyTracker, SomebodySeenFromBehindIsTakenToFaceTheSensor) {
  Room room;
  const auto exact = somebody(0, 2.5, std::numbers::pi);
  ASSERT_GT(std::abs(facing_angle(exact).value()), deg(150));
  room.enter(exact);
  const auto bodies = room.look(10);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_LT(std::abs(facing_angle(bodies[0].skeleton).value()), deg(30));
  EXPECT_LT(to_mm(median_error(bodies[0].skeleton, exact, true)), 60) << "left and right exchanged";
  EXPECT_GT(to_mm(median_error(bodies[0].skeleton, exact)), 150);
}

TEST(BodyTracker, WhoTurnsKeepsTheirLabelsUpToTheSideViewAndLosesThemBeyond) {
  Room room;
  double yaw = 0;
  const auto turn_to = [&](double target) {
    Skeleton<SensorSpace> body;
    while (yaw < target) {
      yaw += deg(3);
      room.view.people.clear();
      room.enter(somebody(0, 2.5, yaw));
      const auto bodies = room.look();
      if (!bodies.empty()) body = bodies[0].skeleton;
    }
    return body;
  };
  const auto aside = turn_to(deg(60));
  EXPECT_LT(median_error(aside, somebody(0, 2.5, yaw)),
            median_error(aside, somebody(0, 2.5, yaw), true));
  const auto behind = turn_to(deg(170));
  EXPECT_GT(median_error(behind, somebody(0, 2.5, yaw)),
            median_error(behind, somebody(0, 2.5, yaw), true));
}

TEST(BodyTracker, ABoxBeforeTheLegsMakesThemInferred) {
  Room room;
  room.enter(somebody(0, 2.5));
  ASSERT_EQ(room.look(5)[0].skeleton[KneeLeft].state, JointState::Tracked);
  kinect::Box box;
  box.sensor_from_box.translation() = Eigen::Vector3d(0, -0.8, 1.6);
  box.half = {0.8, 0.5, 0.05};
  room.view.boxes = {box};
  const auto hidden = room.look(5);
  ASSERT_EQ(hidden.size(), 1u);
  for (const JointId id : {KneeLeft, KneeRight, AnkleLeft, AnkleRight}) {
    EXPECT_EQ(hidden[0].skeleton[id].state, JointState::Inferred) << name_of(id);
  }
  EXPECT_EQ(hidden[0].skeleton[Head].state, JointState::Tracked);
}

TEST(BodyTracker, WhoLeavesIsGoneAndComesBackAsSomebodyElse) {
  Room room;
  room.enter(somebody(0, 2.5));
  const auto first = room.look(5);
  ASSERT_EQ(first.size(), 1u);
  const auto people = std::exchange(room.view.people, {});
  EXPECT_TRUE(room.look(1).empty()) << "at once";
  EXPECT_TRUE(room.look(20).empty());
  room.view.people = people;
  const auto again = room.look(5);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_NE(again[0].id, first[0].id);
}

TEST(BodyTracker, TwoPeopleAreTwoBodiesWithTheirOwnIds) {
  Room room;
  room.enter(somebody(-0.6, 2.5));
  room.enter(somebody(0.6, 2.8));
  const auto before = room.look(5);
  const auto after = room.look(30);
  ASSERT_EQ(before.size(), 2u);
  ASSERT_EQ(after.size(), 2u);
  EXPECT_NE(after[0].id, after[1].id);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(after[i].id, before[i].id);
    EXPECT_NEAR(after[i].skeleton[Neck].position.x(), before[i].skeleton[Neck].position.x(), 0.1);
  }
}

TEST(BodyTracker, FurnitureIsNobody) {
  Room room;
  kinect::Box table;
  table.sensor_from_box.translation() = Eigen::Vector3d(0, -0.8, 2.5);
  table.half = {0.8, 0.4, 0.4};
  kinect::Box pillar;
  pillar.sensor_from_box.translation() = Eigen::Vector3d(0.5, 0.2, 3.5);
  pillar.half = {0.3, 1.4, 0.3};
  room.view.boxes = {table, pillar};
  EXPECT_TRUE(room.look(10).empty());
}

}  // namespace
}  // namespace chorus::synthetic::depth

#include "common/synthetic/kinect/visibility.h"

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "tests/support/builders.h"

namespace chorus::synthetic::kinect {
namespace {

using enum JointId;

/// A person 2.5 m in front of a level sensor at a height of 1 m; `facing` 0: facing the sensor.
Skeleton<SensorSpace> person(double facing, double x = 0.0, double distance = 2.5) {
  const Eigen::Isometry3d world_from_sensor = testing::sensor_pose({0, 1, 0}, 0.0);
  return to_sensor(world_from_sensor.inverse(),
                   testing::standing_person({x, 0, distance}, deg(180) + facing));
}

Obstacles only(const Skeleton<SensorSpace>& body) { return {{capsules_of(body)}, {}}; }

std::array<double, kJointCount> seen(const Skeleton<SensorSpace>& body,
                                     const Obstacles& obstacles) {
  return visible_share(body, 0, obstacles, nominal_profile("A").visibility);
}

TEST(Visibility, AFacingPersonIsSeenWhole) {
  const auto body = person(0);
  const auto share = seen(body, only(body));
  for (const JointId id : {Head, Neck, ShoulderLeft, ShoulderRight, ElbowLeft, ElbowRight, HipLeft,
                           KneeLeft, KneeRight, AnkleLeft, AnkleRight}) {
    EXPECT_GT(share[index_of(id)], 0.7) << name_of(id);
  }
}

TEST(Visibility, TheOwnTrunkHidesTheFarArmFromTheSide) {
  for (const double side : {1.0, -1.0}) {
    const auto body = person(side * deg(90));
    const auto share = seen(body, only(body));
    const bool left_far = body[ElbowLeft].position.z() > body[ElbowRight].position.z();
    const JointId far = left_far ? ElbowLeft : ElbowRight;
    const JointId near = left_far ? ElbowRight : ElbowLeft;
    EXPECT_LT(share[index_of(far)], 0.2);
    EXPECT_GT(share[index_of(near)], 0.8);
  }
}

TEST(Visibility, TheCoreIsNeverHiddenByTheBodyItself) {
  for (int angle = -180; angle < 180; angle += 15) {
    const auto body = person(deg(angle));
    const auto share = seen(body, only(body));
    for (const JointId id : kCoreJoints) EXPECT_EQ(share[index_of(id)], 1.0) << angle;
  }
}

TEST(Visibility, APillarHidesWhatIsBehindItAndNothingElse) {
  const auto body = person(0);
  Obstacles obstacles = only(body);
  Box pillar;
  pillar.half = {0.1, 3.0, 0.1};
  pillar.sensor_from_box.translation() = Eigen::Vector3d(0.0, 0.0, 1.2);
  obstacles.boxes = {pillar};
  const auto share = seen(body, obstacles);
  EXPECT_EQ(share[index_of(Neck)], 0.0);
  EXPECT_EQ(share[index_of(SpineBase)], 0.0);
  obstacles.boxes[0].sensor_from_box.translation().z() = 4.0;
  EXPECT_EQ(seen(body, obstacles)[index_of(Neck)], 1.0) << "behind the person it hides nothing";
  obstacles.boxes[0].sensor_from_box.translation() = Eigen::Vector3d(1.0, 0.0, 1.2);
  EXPECT_EQ(seen(body, obstacles)[index_of(Neck)], 1.0) << "nor beside the line of sight";
}

TEST(Visibility, AnotherPersonHidesTheCoreToo) {
  const auto body = person(0);
  Obstacles obstacles = only(body);
  obstacles.bodies.push_back(capsules_of(person(0, 0.0, 1.5)));
  EXPECT_LT(seen(body, obstacles)[index_of(SpineMid)], 0.2);
}

TEST(Visibility, ABoxIsHitFromOutsideAndFromInsideButNotBeyondTheEnd) {
  Box box;
  box.sensor_from_box.translation() = Eigen::Vector3d(0, 0, 2);
  EXPECT_TRUE(blocks(box, {0, 0, 3}));
  EXPECT_FALSE(blocks(box, {0, 0, 1.4}));
  EXPECT_FALSE(blocks(box, {2, 0, 3}));
  EXPECT_TRUE(blocks(box, {0, 0, 2})) << "the end lies inside";
  box.sensor_from_box.translation() = Eigen::Vector3d(0, 0, 0);
  EXPECT_TRUE(blocks(box, {0, 0, 2})) << "the sensor stands inside";
}

TEST(Visibility, NoRaysMeansAllVisible) {
  const auto body = person(deg(90));
  Visibility none;
  for (const double share : visible_share(body, 0, only(body), none)) EXPECT_EQ(share, 1.0);
}

TEST(Visibility, ABodyAtTheOriginOrUnseenIsSurvived) {
  const Skeleton<SensorSpace> nobody;
  for (const double share : seen(nobody, only(nobody))) EXPECT_EQ(share, 1.0);
}

TEST(Notice, ALegThatPassesIsTrackedOnAndAHiddenSideIsLost) {
  const Visibility visibility = nominal_profile("A").visibility;
  std::array<double, kJointCount> hidden{};
  std::array<double, kJointCount> visible{};
  visible.fill(0.0);
  const auto after = [&](double time) {
    for (double t = 0; t < time; t += 0.033) notice(hidden, visible, 0.033, visibility);
    return hidden[index_of(KneeLeft)];
  };
  EXPECT_LT(after(0.07), 0.5);
  EXPECT_GT(after(1.0), 0.95);
  visible.fill(1.0);
  EXPECT_LT(after(1.0), 0.05) << "and found again";
  Visibility at_once = visibility;
  at_once.notice = 0;
  visible.fill(0.25);
  notice(hidden, visible, 0.033, at_once);
  EXPECT_EQ(hidden[index_of(KneeLeft)], 0.75);
}

}  // namespace
}  // namespace chorus::synthetic::kinect

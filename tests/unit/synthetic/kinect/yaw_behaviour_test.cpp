#include "common/synthetic/kinect/yaw_behaviour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"
#include "common/body/facing.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::synthetic::kinect {
namespace {

using enum JointId;

const YawBehaviour kBehaviour = nominal_profile("A").yaw;

Skeleton<SensorSpace> turned(double facing) {
  const Eigen::Isometry3d world_from_sensor = testing::sensor_pose({0, 1, 0}, 0.0);
  return to_sensor(world_from_sensor.inverse(),
                   testing::standing_person({0, 0, 2.3}, deg(180) + facing));
}

/// The state after turning slowly from `from` to `to`.
FlipState turn(FlipState state, double from, double to) {
  const double step = to > from ? deg(0.5) : -deg(0.5);
  for (int i = 0; i <= static_cast<int>(std::abs(to - from) / deg(0.5)); ++i) {
    advance(state, wrap_angle(from + i * step), 0.033, kBehaviour);
  }
  return state;
}

TEST(YawBehaviour, IsRightUpToFortyDegreesAndLagsBeyond) {
  for (const double yaw : {-40.0, -20.0, 0.0, 39.0}) {
    EXPECT_DOUBLE_EQ(shown_yaw(deg(yaw), kBehaviour.shoulder_slope, kBehaviour), deg(yaw));
  }
  const double shoulders = shown_yaw(deg(90), kBehaviour.shoulder_slope, kBehaviour);
  const double hips = shown_yaw(deg(90), kBehaviour.hip_slope, kBehaviour);
  EXPECT_NEAR(shoulders, deg(40) + kBehaviour.shoulder_slope * deg(50), 1e-12);
  EXPECT_LT(hips, shoulders) << "hips lag more";
  EXPECT_GT(hips, deg(40));
  EXPECT_DOUBLE_EQ(shown_yaw(deg(-90), 0.55, kBehaviour), -shown_yaw(deg(90), 0.55, kBehaviour));
}

TEST(YawBehaviour, FlipsAtOneAngleAndBackAtAnother) {
  EXPECT_FALSE(turn({}, 0, deg(129)).rear);
  const FlipState rear = turn({}, 0, deg(131));
  EXPECT_TRUE(rear.rear);
  EXPECT_TRUE(turn(rear, deg(131), deg(61)).rear) << "hysteresis: it stays";
  EXPECT_FALSE(turn(rear, deg(131), deg(59)).rear);
  EXPECT_TRUE(turn({}, 0, deg(-131)).rear) << "the same to the other side";
  EXPECT_TRUE(turn(rear, deg(131), deg(299)).rear);
  EXPECT_FALSE(turn(rear, deg(131), deg(301)).rear) << "all the way round: 300 is 60 from front";
}

TEST(YawBehaviour, ChangesItsMindOverSomeFrames) {
  FlipState state;
  advance(state, deg(0), 0.033, kBehaviour);
  advance(state, deg(140), 0.033, kBehaviour);
  EXPECT_TRUE(state.rear);
  EXPECT_GT(state.blend, 0.0);
  EXPECT_LT(state.blend, 0.5);
  for (int i = 0; i < 6; ++i) advance(state, deg(140), 0.033, kBehaviour);
  EXPECT_EQ(state.blend, 1.0);
}

TEST(YawBehaviour, WhomItMeetsItTakesToFaceIt) {
  const auto met_at = [](double facing) {
    FlipState state;
    advance(state, facing, 0.033, kBehaviour);
    return state;
  };
  EXPECT_FALSE(met_at(deg(94)).rear);
  EXPECT_TRUE(met_at(deg(-96)).rear) << "as near to the back as to the front";
  EXPECT_EQ(met_at(deg(96)).blend, 1.0) << "at once";
  const YawBehaviour never = nominal_profile("D").yaw;
  FlipState state;
  for (int i = 0; i < 10; ++i) advance(state, deg(180), 0.033, never);
  EXPECT_FALSE(state.rear);
}

TEST(OwnBehaviour, SpreadsTheWayBackOverOttosWindowAndKeepsTheWayOut) {
  const YawBehaviour a = nominal_profile("A").yaw;
  double least = deg(180);
  double most = 0;
  for (std::uint64_t sensor = 0; sensor < 200; ++sensor) {
    const YawBehaviour own = own_behaviour(a, 1, sensor);
    EXPECT_EQ(own.flip_to_rear, a.flip_to_rear);
    least = std::min(least, own.flip_to_front);
    most = std::max(most, own.flip_to_front);
  }
  EXPECT_NEAR(least, deg(45), deg(1));
  EXPECT_NEAR(most, deg(75), deg(1));
}

TEST(OwnBehaviour, MovesBothAnglesOfBTogether) {
  const YawBehaviour b = nominal_profile("B").yaw;
  bool differ = false;
  for (std::uint64_t sensor = 0; sensor < 50; ++sensor) {
    const YawBehaviour own = own_behaviour(b, 1, sensor);
    EXPECT_NEAR(own.flip_to_rear, own.flip_to_front, 1e-12) << "no hysteresis";
    EXPECT_LE(std::abs(own.flip_to_rear - b.flip_to_rear), deg(15));
    differ |= std::abs(own.flip_to_rear - b.flip_to_rear) > deg(10);
  }
  EXPECT_TRUE(differ);
}

TEST(YawBehaviour, FromTheFrontTheBodyIsUnchanged) {
  const auto body = turned(deg(30));
  const auto shown = as_shown(body, facing_angle(body).value(), {}, kBehaviour);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    EXPECT_NEAR((shown.joints[i].position - body.joints[i].position).norm(), 0, 1e-9);
  }
}

TEST(YawBehaviour, FromBehindLeftAndRightAreExchangedInPlace) {
  const auto body = turned(deg(180));
  const FlipState rear{true, 1.0};
  const auto shown = as_shown(body, facing_angle(body).value(), rear, kBehaviour);
  for (const auto& [left, right] : kMirrorPairs) {
    EXPECT_NEAR((shown[left].position - body[right].position).norm(), 0, 1e-6) << name_of(left);
    EXPECT_NEAR((shown[right].position - body[left].position).norm(), 0, 1e-6) << name_of(left);
  }
  for (const JointId id : kCoreJoints) {
    EXPECT_EQ(shown[id].position, body[id].position) << name_of(id);
  }
  EXPECT_NEAR(facing_angle(shown).value(), 0.0, deg(1)) << "it is shown as if it faced the sensor";
}

TEST(YawBehaviour, AtNinetyDegreesTheShouldersAreShownTurnedLess) {
  for (const double side : {1.0, -1.0}) {
    const auto body = turned(side * deg(90));
    const auto shown = as_shown(body, facing_angle(body).value(), {}, kBehaviour);
    const double expected = side * shown_yaw(deg(90), kBehaviour.shoulder_slope, kBehaviour);
    const double before = facing_angle(body).value();
    EXPECT_NEAR(before, side * deg(90), deg(1));
    EXPECT_NEAR(facing_angle(shown).value(), expected, deg(2));
  }
}

TEST(YawBehaviour, WhileItFlipsTheLimbsAreInferred) {
  const auto body = turned(deg(135));
  const auto between = as_shown(body, deg(135), {true, 0.5}, kBehaviour);
  EXPECT_EQ(between[ShoulderLeft].state, JointState::Inferred);
  EXPECT_EQ(between[Neck].state, JointState::Tracked);
}

TEST(MisjudgedYaw, GrowsUntilTheFlipAndIsSmallAgainBehindIt) {
  const YawBehaviour yaw = nominal_profile("A").yaw;
  const FlipState front{};
  const FlipState rear{true, 1.0};
  EXPECT_EQ(misjudged_yaw(deg(40), front, yaw), 0.0);
  EXPECT_NEAR(misjudged_yaw(deg(90), front, yaw), deg(50) * (1 - yaw.shoulder_slope), 1e-9);
  EXPECT_NEAR(misjudged_yaw(-deg(130), front, yaw), deg(90) * (1 - yaw.shoulder_slope), 1e-9);
  EXPECT_NEAR(misjudged_yaw(deg(180), rear, yaw), 0.0, 1e-9);
  EXPECT_NEAR(misjudged_yaw(deg(120), rear, yaw), deg(20) * (1 - yaw.shoulder_slope), 1e-9);
}

}  // namespace
}  // namespace chorus::synthetic::kinect

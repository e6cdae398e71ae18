// Tests that the person that other tests rely on is plausible, symmetric and at the given place.
#include "tests/support/builders.h"

#include <numbers>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/body/facing.h"
#include "common/geometry/rotation.h"
#include "tests/support/matchers.h"

namespace chorus::testing {
namespace {

TEST(StandingPerson, StandsOnTheFloorAndIsOfHumanSize) {
  const auto person = standing_person({1, 0, 2}, deg(40));
  for (const Joint& joint : person.joints) {
    EXPECT_EQ(joint.state, JointState::Tracked);
    EXPECT_GT(joint.position.y(), 0.0);
    EXPECT_LT(joint.position.y(), 1.75);
  }
  for (const Bone& bone : kBones) {
    const double length = (person[bone.child].position - person[bone.parent].position).norm();
    EXPECT_GT(length, 0.04) << name_of(bone.child);
    EXPECT_LT(length, 0.45) << name_of(bone.child);
  }
}

TEST(StandingPerson, IsSymmetricWithItsLeftAtPlusX) {
  for (const auto& person : {standing_person(), t_pose_person()}) {
    for (const auto& [left, right] : kMirrorPairs) {
      EXPECT_GT(person[left].position.x(), 0.0);
      const Eigen::Vector3d mirrored =
          person[right].position.cwiseProduct(Eigen::Vector3d(-1, 1, 1));
      EXPECT_THAT(mirrored, VectorNear(person[left].position, 1e-12));
    }
  }
}

TEST(StandingPerson, TurnsAboutItsPlace) {
  const auto turned = standing_person({1, 0, 2}, deg(90));
  EXPECT_THAT(turned[JointId::SpineBase].position, VectorNear(Eigen::Vector3d(1, 0.95, 2), 1e-9));
  const Eigen::Vector3d to_left =
      turned[JointId::ShoulderLeft].position - turned[JointId::ShoulderRight].position;
  EXPECT_THAT(to_left.normalized(), VectorNear(Eigen::Vector3d(0, 0, -1), 1e-9));
  EXPECT_THAT(turned[JointId::SpineMid].orientation, RotationNear(about_y(deg(90)), 1e-9));
}

TEST(TPosePerson, KeepsTheBoneLengthsOfTheStandingOne) {
  const auto standing = standing_person();
  const auto stretched = t_pose_person();
  for (const Bone& bone : kBones) {
    const auto length = [&](const Skeleton<WorldSpace>& body) {
      return (body[bone.child].position - body[bone.parent].position).norm();
    };
    EXPECT_NEAR(length(standing), length(stretched), mm(10)) << name_of(bone.child);
  }
}

TEST(RingSensor, EverySensorSeesThePersonAtTheCentreStraightAhead) {
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d world_from_sensor = ring_sensor(i, 6, 2.5, 1.5);
    const auto seen = body_seen_from(world_from_sensor, standing_person(), kStart);
    EXPECT_THAT(seen.skeleton[JointId::Neck].position,
                VectorNear(Eigen::Vector3d(0, 0, 2.5), 1e-9));
    EXPECT_NEAR(bearing_angle(seen.skeleton).value(), 0.0, 1e-9);
    // Sensor 0 looks along +z at a person who faces +z: it sees the back.
    const double facing = facing_angle(seen.skeleton).value();
    EXPECT_NEAR(std::abs(wrap_angle(facing + deg(60) * i)), std::numbers::pi, 1e-9);
  }
}

TEST(SensorPose, PitchLooksDownAndTheFloorStaysTheFloor) {
  const Eigen::Isometry3d world_from_sensor = sensor_pose({0, 1.8, 0}, deg(30), deg(20));
  const Eigen::Vector3d ahead = world_from_sensor.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(ahead.y(), -std::sin(deg(20)), 1e-12);
  const FloorPlane floor = floor_seen_from(world_from_sensor);
  const Eigen::Vector3d on_floor_in_sensor =
      world_from_sensor.inverse() * Eigen::Vector3d(0.7, 0, 1.9);
  EXPECT_NEAR(floor.distance(on_floor_in_sensor), 0.0, 1e-12);
  EXPECT_NEAR(floor.distance(Eigen::Vector3d::Zero()), 1.8, 1e-12);
}

TEST(SensorFrameBuilder, CountsFramesSinceTheStart) {
  const SensorFrame frame = sensor_frame("s1", kStart + 3 * kFrameInterval, {});
  EXPECT_EQ(frame.sequence, 3u);
  EXPECT_EQ(frame.sensor.str(), "s1");
  EXPECT_EQ(to_iso8601(kStart), "2026-11-21T07:30:00.000000000Z");
}

}  // namespace
}  // namespace chorus::testing

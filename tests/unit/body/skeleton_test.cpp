#include "common/body/skeleton.h"

#include <concepts>
#include <limits>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::RotationNear;
using testing::sensor_pose;
using testing::SkeletonNear;
using testing::standing_person;
using testing::VectorNear;

// A world skeleton cannot be moved into the world again, nor a sensor skeleton be used as a world
// one.
template <class Body>
concept GoesToWorld = requires(const Eigen::Isometry3d& pose, const Body& body) {
  to_world(pose, body);
};
static_assert(GoesToWorld<Skeleton<SensorSpace>>);
static_assert(!GoesToWorld<Skeleton<WorldSpace>>);
static_assert(!std::convertible_to<Skeleton<SensorSpace>, Skeleton<WorldSpace>>);

TEST(JointSeen, NeedsAStateAndAFinitePlace) {
  Joint joint;
  EXPECT_FALSE(joint.seen());
  joint.state = JointState::Inferred;
  EXPECT_TRUE(joint.seen());
  joint.state = JointState::Tracked;
  EXPECT_TRUE(joint.seen());
  joint.position.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(joint.seen());
  joint.position.y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(joint.seen());
}

TEST(ToWorld, UndoesToSensor) {
  const auto person = standing_person({0.5, 0, 1}, deg(70));
  const Eigen::Isometry3d world_from_sensor = sensor_pose({2, 1.5, -1}, deg(-30), deg(15));
  const auto seen = to_sensor(world_from_sensor.inverse(), person);
  const auto back = to_world(world_from_sensor, seen);
  EXPECT_THAT(back, SkeletonNear(person, 1e-9));
  EXPECT_THAT(back[JointId::SpineMid].orientation,
              RotationNear(person[JointId::SpineMid].orientation, 1e-9));
}

TEST(ToWorld, KeepsLengthsStatesAndAbsentOrientations) {
  auto person = standing_person();
  person[JointId::HandLeft].state = JointState::Inferred;
  const auto seen = to_sensor(sensor_pose({1, 2, 3}, 1.0, 0.5).inverse(), person);
  EXPECT_EQ(seen[JointId::HandLeft].state, JointState::Inferred);
  EXPECT_EQ(seen[JointId::Head].orientation.coeffs().norm(), 0.0) << "all zero means: not given";
  for (const Bone& bone : kBones) {
    const double before = (person[bone.child].position - person[bone.parent].position).norm();
    const double after = (seen[bone.child].position - seen[bone.parent].position).norm();
    EXPECT_NEAR(before, after, 1e-9);
  }
}

TEST(ToWorld, TurnsOrientationsWithTheSensor) {
  // A sensor in front of the person: +z of the sensor is -z of the world.
  const Eigen::Isometry3d world_from_sensor = sensor_pose({0, 1, 3}, deg(180));
  const auto seen = to_sensor(world_from_sensor.inverse(), standing_person());
  const Eigen::Vector3d body_forward_in_sensor =
      seen[JointId::SpineMid].orientation * Eigen::Vector3d::UnitZ();
  EXPECT_THAT(body_forward_in_sensor, VectorNear(Eigen::Vector3d(0, 0, -1), 1e-9));
}

TEST(Joint, ARayHasADirectionAndNoPlace) {
  Joint joint{Eigen::Vector3d::UnitZ(), Eigen::Quaterniond(0, 0, 0, 0), JointState::Tracked,
              Measurement::Ray};
  EXPECT_FALSE(joint.seen());
  EXPECT_TRUE(joint.bears());
  joint.state = JointState::NotTracked;
  EXPECT_FALSE(joint.bears());
}

TEST(Body, IsOfRaysAloneWithOneRayAndNoPoint) {
  Skeleton<WorldSpace> body;
  EXPECT_FALSE(has_rays_alone(body.joints));
  body[JointId::Head] = {Eigen::Vector3d::UnitZ(), Eigen::Quaterniond(0, 0, 0, 0),
                         JointState::Inferred, Measurement::Ray};
  EXPECT_TRUE(has_rays_alone(body.joints));
  body[JointId::Neck].state = JointState::Tracked;
  EXPECT_FALSE(has_rays_alone(body.joints));
}

TEST(ToWorld, TurnsRaysAndCovariancesButDoesNotMoveRays) {
  Skeleton<SensorSpace> seen;
  Joint& head = seen[JointId::Head];
  head = {Eigen::Vector3d::UnitZ(), Eigen::Quaterniond(0, 0, 0, 0), JointState::Tracked,
          Measurement::Ray};
  head.covariance = Covariance(Eigen::Vector3d(1e-4, 2e-4, 9e-4).asDiagonal().toDenseMatrix());
  const auto body = to_world(sensor_pose({5, 1, 3}, deg(90)), seen);
  EXPECT_EQ(body[JointId::Head].measurement, Measurement::Ray);
  EXPECT_THAT(body[JointId::Head].position, VectorNear(Eigen::Vector3d::UnitX(), 1e-9));
  EXPECT_NEAR(body[JointId::Head].covariance.matrix()(0, 0), 9e-4, 1e-8);
}

}  // namespace
}  // namespace chorus

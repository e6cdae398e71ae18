// The angles of Otto Eqs. (2) and (3), and their sign, on which all later stages rely: positive
// facing is a rotation about +y (up), so a body that turns to its own left turns positively.
#include "common/body/facing.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::hide;
using testing::sensor_pose;
using testing::standing_person;

constexpr double kExact = 1e-9;

/// A sensor at the origin looks along +z; the person stands at `place` and is turned away from
/// facing it.
Skeleton<SensorSpace> person_before_sensor(double x, double z, double turned_away) {
  const Eigen::Isometry3d world_from_sensor = sensor_pose({0, 1.2, 0}, 0.0);
  const double towards_sensor = std::atan2(-x, -z);
  return to_sensor(world_from_sensor.inverse(),
                   standing_person({x, 0, z}, towards_sensor + turned_away));
}

TEST(FacingAngle, IsZeroForAChestTurnedToTheSensorWhereverItStands) {
  for (const double x : {-1.5, 0.0, 0.7}) {
    EXPECT_NEAR(facing_angle(person_before_sensor(x, 2.5, 0.0)).value(), 0.0, kExact) << x;
  }
}

TEST(FacingAngle, FollowsTheTurnWithItsSign) {
  for (double turn = -175; turn <= 180; turn += 5) {
    const auto facing = facing_angle(person_before_sensor(0.4, 2.0, deg(turn)));
    ASSERT_TRUE(facing);
    EXPECT_NEAR(wrap_angle(*facing - deg(turn)), 0.0, kExact) << turn;
    EXPECT_GT(*facing, -std::numbers::pi);
    EXPECT_LE(*facing, std::numbers::pi);
  }
}

TEST(FacingAngle, SwappedSidesReadAsTheBack) {
  // From behind, a frontal tracker swaps left and right (Otto 3.2).
  auto body = person_before_sensor(0, 2.5, deg(20));
  std::swap(body[JointId::ShoulderLeft], body[JointId::ShoulderRight]);
  EXPECT_NEAR(facing_angle(body).value(), deg(20) - std::numbers::pi, kExact);
}

TEST(FacingAngle, TakesTheHipsWhenAShoulderIsNotSeen) {
  auto body = person_before_sensor(0.3, 2.5, deg(-40));
  hide(body[JointId::ShoulderRight]);
  EXPECT_NEAR(facing_angle(body).value(), deg(-40), kExact);
  hide(body[JointId::HipLeft]);
  EXPECT_EQ(facing_angle(body), std::nullopt);
}

TEST(FacingAngle, HasNoAnswerForDegenerateBodies) {
  EXPECT_EQ(facing_angle(Skeleton<SensorSpace>{}), std::nullopt);
  auto vertical = person_before_sensor(0, 2.5, 0);
  for (const JointId id : {JointId::ShoulderLeft, JointId::HipLeft}) {
    vertical[id].position = vertical[JointId::ShoulderRight].position + Eigen::Vector3d(0, 0.1, 0);
  }
  vertical[JointId::HipRight].position = vertical[JointId::ShoulderRight].position;
  EXPECT_EQ(facing_angle(vertical), std::nullopt);
  auto above = person_before_sensor(0, 2.5, 0);
  above[JointId::Neck].position = {0, 1.0, 0};
  EXPECT_EQ(facing_angle(above), std::nullopt);
  auto broken = person_before_sensor(0, 2.5, 0);
  for (Joint& joint : broken.joints) joint.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(facing_angle(broken), std::nullopt);
}

TEST(FacingAngle, UsesTheSpineBaseForTheLineOfSightWhenTheNeckIsNotSeen) {
  auto body = person_before_sensor(1.0, 2.0, deg(15));
  hide(body[JointId::Neck]);
  EXPECT_NEAR(facing_angle(body).value(), deg(15), kExact);
  hide(body[JointId::SpineBase]);
  EXPECT_EQ(facing_angle(body), std::nullopt);
}

TEST(BearingAngle, IsTheHorizontalAngleOffTheOpticalAxis) {
  EXPECT_NEAR(bearing_angle(person_before_sensor(0, 2, 1)).value(), 0.0, kExact);
  EXPECT_NEAR(bearing_angle(person_before_sensor(2, 2, 0)).value(), deg(45), kExact);
  EXPECT_NEAR(bearing_angle(person_before_sensor(-2, 2, 0)).value(), deg(-45), kExact);
  auto body = person_before_sensor(0, 2, 0);
  hide(body[JointId::Neck]);
  EXPECT_EQ(bearing_angle(body), std::nullopt);
}

TEST(NeckDistance, IsMeasuredFromTheSensor) {
  // The neck is at 1.5 m, the sensor at 1.2 m.
  EXPECT_NEAR(neck_distance(person_before_sensor(3, 4, 0)).value(), std::hypot(5.0, 0.3), kExact);
  auto body = person_before_sensor(0, 2, 0);
  hide(body[JointId::Neck]);
  EXPECT_EQ(neck_distance(body), std::nullopt);
}

TEST(AxisBearing, IsThatOfTheFarthestJointOfTheCentreAxis) {
  auto body = person_before_sensor(0.0, 2.5, 0.0);
  body[JointId::Head].position = {0.5, 0.4, 2.5};
  body[JointId::HandLeft].position = {2.0, 0.0, 2.5};
  EXPECT_NEAR(axis_bearing_angle(body).value(), std::atan2(0.5, 2.5), kExact);
  EXPECT_NEAR(bearing_angle(body).value(), 0.0, kExact);
  body[JointId::SpineBase].position = {-0.6, -0.3, 2.5};
  EXPECT_NEAR(axis_bearing_angle(body).value(), std::atan2(-0.6, 2.5), kExact);
  EXPECT_FALSE(axis_bearing_angle(Skeleton<SensorSpace>{}).has_value());
}

}  // namespace
}  // namespace chorus

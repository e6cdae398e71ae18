#include "common/posture/isb.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "tests/support/builders.h"

namespace chorus::posture {
namespace {

using enum JointId;

std::array<double, 3> row(const IsbAngles& angles, std::string_view name) {
  for (std::size_t i = 0; i < kIsbJoints; ++i)
    if (isb_rows()[i].name == name) return angles[i];
  return {};
}

Skeleton<WorldSpace> person() { return chorus::testing::standing_person(); }

TEST(IsbAngles, OfAForwardRaisedArmHaveAPlaneOfNinetyDegrees) {
  for (const bool left : {true, false}) {
    auto body = person();
    const JointId shoulder = left ? ShoulderLeft : ShoulderRight;
    const JointId elbow = left ? ElbowLeft : ElbowRight;
    const JointId wrist = left ? WristLeft : WristRight;
    body[elbow].position = body[shoulder].position + Eigen::Vector3d(0, 0, 0.3);
    body[wrist].position = body[elbow].position + Eigen::Vector3d(0, 0.25, 0);
    const auto angles = isb_angles(points_of(body));
    const auto arm = row(angles, left ? "leftShoulder" : "rightShoulder");
    EXPECT_NEAR(arm[0], deg(90), deg(3));
    EXPECT_NEAR(arm[1], deg(-90), deg(4));
    EXPECT_NEAR(row(angles, left ? "leftElbow" : "rightElbow")[0], deg(90), deg(1));
  }
}

TEST(IsbAngles, OfASidewaysRaisedArmHaveAPlaneOfZero) {
  const auto angles = isb_angles(points_of(chorus::testing::t_pose_person()));
  EXPECT_NEAR(row(angles, "rightShoulder")[0], 0.0, deg(5));
  EXPECT_NEAR(row(angles, "leftShoulder")[1], deg(-90), deg(5));
  EXPECT_TRUE(std::isnan(row(angles, "leftShoulder")[2])) << "a straight arm shows no rotation";
}

TEST(IsbAngles, OfALiftedKneeFlexTheHipAndBendTheKneeBackward) {
  auto body = person();
  body[KneeLeft].position = body[HipLeft].position + Eigen::Vector3d(0, 0, 0.42);
  body[AnkleLeft].position = body[KneeLeft].position + Eigen::Vector3d(0, -0.4, 0);
  const auto angles = isb_angles(points_of(body));
  EXPECT_NEAR(row(angles, "leftHip")[0], deg(90), deg(4));
  EXPECT_NEAR(row(angles, "leftKnee")[0], deg(-90), deg(4));
  EXPECT_NEAR(row(angles, "rightHip")[0], 0.0, deg(4));
}

TEST(IsbAngles, OfABodyBentForwardExtendTheSpineNegatively) {
  auto body = person();
  const Eigen::Vector3d hips = 0.5 * (body[HipLeft].position + body[HipRight].position);
  for (const JointId id : {ShoulderLeft, ShoulderRight})
    body[id].position =
        hips + Eigen::AngleAxisd(deg(50), Eigen::Vector3d::UnitX()) * (body[id].position - hips);
  EXPECT_NEAR(row(isb_angles(points_of(body)), "spine")[0], deg(-50), deg(4));
}

TEST(IsbAngles, OfNobodyAreUndefined) {
  for (const auto& angles : isb_angles({}))
    for (const double angle : angles) EXPECT_TRUE(std::isnan(angle));
}

}  // namespace
}  // namespace chorus::posture

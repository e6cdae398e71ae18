#include "common/posture/posture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/posture/spread.h"
#include "tests/support/builders.h"

namespace chorus::posture {
namespace {

using testing::standing_person;
using testing::t_pose_person;
using enum JointId;

/// Turns the joints above the hips about them by `angle` about `axis`.
Skeleton<WorldSpace> with_trunk_turned(Skeleton<WorldSpace> body, double angle,
                                       const Eigen::Vector3d& axis) {
  const Eigen::Vector3d hips = 0.5 * (body[HipLeft].position + body[HipRight].position);
  const Eigen::AngleAxisd turn(angle, axis);
  for (const JointId id : {SpineMid, Neck, Head, SpineShoulder, ShoulderLeft, ShoulderRight,
                           ElbowLeft, ElbowRight, WristLeft, WristRight, HandLeft, HandRight})
    body[id].position = hips + turn * (body[id].position - hips);
  return body;
}

Measures of(const Skeleton<WorldSpace>& body) { return posture_of(body).measures; }

TEST(TrunkMeasures, StandingIsZero) {
  const Posture posture = posture_of(standing_person({1, 0, 2}, 0.7));
  EXPECT_NEAR(posture.measures[Centre::TrunkFlexion], 0.0, deg(3));
  EXPECT_NEAR(posture.measures[Centre::TrunkSideBend], 0.0, 1e-6);
  EXPECT_NEAR(posture.measures[Centre::TrunkTwist], 0.0, 1e-6);
  EXPECT_FALSE(posture.singular.any());
}

TEST(TrunkMeasures, EachBendChangesItsOwnMeasureWithItsSign) {
  const auto body = standing_person();  // faces +z, left at +x
  const double zero = of(body)[Centre::TrunkFlexion];
  const auto forward = of(with_trunk_turned(body, deg(40), Eigen::Vector3d::UnitX()));
  EXPECT_NEAR(forward[Centre::TrunkFlexion] - zero, deg(40), 1e-9);
  EXPECT_NEAR(forward[Centre::TrunkSideBend], 0.0, 1e-9);
  const auto left = of(with_trunk_turned(body, deg(-25), Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(left[Centre::TrunkSideBend], deg(25), deg(0.1));
  const auto twisted = of(with_trunk_turned(body, deg(30), Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(twisted[Centre::TrunkTwist], deg(30), deg(0.2));
}

TEST(TrunkMeasures, BentBeyondLevelDoesNotJump) {
  const auto body = standing_person();
  const double zero = of(body)[Centre::TrunkFlexion];
  for (double bend = 80; bend <= 120; bend += 5) {
    const auto bent = of(with_trunk_turned(body, deg(bend), Eigen::Vector3d::UnitX()));
    EXPECT_NEAR(bent[Centre::TrunkFlexion] - zero, deg(bend), 1e-9);
  }
}

TEST(TrunkMeasures, LyingSidewaysIsSaidToBeSingular) {
  const auto lying =
      posture_of(with_trunk_turned(standing_person(), deg(-85), Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(lying.singular.trunk_level);
  EXPECT_TRUE(std::isnan(lying.measures[Centre::TrunkFlexion]));
  EXPECT_NEAR(lying.measures[Centre::TrunkSideBend], deg(85), deg(0.1));
}

TEST(TrunkMeasures, SteepHipsLeaveNoForward) {
  auto body = standing_person();
  body[HipRight].position = body[HipLeft].position - Eigen::Vector3d(0.02, 0.2, 0);
  const auto posture = posture_of(body);
  EXPECT_TRUE(posture.singular.hips_steep);
  EXPECT_TRUE(std::isnan(posture.measures[Centre::TrunkFlexion]));
}

TEST(ArmMeasures, TPoseIsRaisedAndAbductedSquarely) {
  const auto measures = of(t_pose_person());
  for (const Side side : kSides) {
    EXPECT_NEAR(measures.at(Limb::UpperArmElevation, side), deg(90), deg(1));
    EXPECT_NEAR(measures.at(Limb::UpperArmRaise, side), deg(90), deg(4));
    EXPECT_NEAR(measures.at(Limb::UpperArmAbduction, side), deg(90), deg(4));
    EXPECT_NEAR(measures.at(Limb::ElbowFlexion, side), 0.0, deg(1));
    EXPECT_GT(measures.at(Limb::ForearmOut, side), 0.4);
  }
}

/// The left upper arm turned about the shoulder.
Measures with_arm(double forward, double outward) {
  auto body = standing_person();
  const Eigen::Vector3d shoulder = body[ShoulderLeft].position;
  const Eigen::Vector3d down(0, -0.3, 0);
  body[ElbowLeft].position =
      shoulder + Eigen::AngleAxisd(-forward, Eigen::Vector3d::UnitX()) *
                     (Eigen::AngleAxisd(outward, Eigen::Vector3d::UnitZ()) * down);
  return of(body);
}

TEST(ArmMeasures, BehindIsNegativeAndOverheadDoesNotJump) {
  EXPECT_GT(with_arm(deg(40), 0).at(Limb::UpperArmRaise, Side::Left), deg(30));
  EXPECT_LT(with_arm(deg(-40), 0).at(Limb::UpperArmRaise, Side::Left), deg(-30));
  const double before = with_arm(deg(176), 0).at(Limb::UpperArmRaise, Side::Left);
  const double behind = with_arm(deg(184), 0).at(Limb::UpperArmRaise, Side::Left);
  EXPECT_NEAR(before, behind, deg(10));
  EXPECT_GT(behind, deg(160));
}

TEST(LegMeasures, KneesFeetAndHeights) {
  auto body = standing_person();
  body[AnkleLeft].position = body[KneeLeft].position + Eigen::Vector3d(0, 0, -0.4);
  const auto measures = of(body);
  EXPECT_NEAR(measures.at(Limb::KneeFlexion, Side::Left), deg(90), deg(3));
  EXPECT_NEAR(measures.at(Limb::KneeFlexion, Side::Right), 0.0, deg(8));
  EXPECT_GT(measures.at(Limb::FootLift, Side::Left), 0.3);
  EXPECT_EQ(measures.at(Limb::FootLift, Side::Right), 0.0);
}

TEST(NeckMeasures, ComeFromTheHeadsOrientationWhereItIsKnown) {
  auto body = standing_person();
  EXPECT_TRUE(std::isnan(of(body)[Centre::NeckTwist]));
  body[Head].orientation = Eigen::AngleAxisd(deg(30), Eigen::Vector3d::UnitY());
  EXPECT_NEAR(of(body)[Centre::NeckTwist], deg(30), deg(0.5));
  body[Head].orientation = Eigen::AngleAxisd(deg(25), Eigen::Vector3d::UnitX());
  const double trunk = of(body)[Centre::TrunkFlexion];
  EXPECT_NEAR(of(body)[Centre::NeckFlexion], deg(25) - trunk, deg(0.5));
  // A roll about the line of sight changes neither; side bend is that of the head's place.
  body[Head].orientation =
      body[Head].orientation * Eigen::AngleAxisd(deg(20), Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(of(body)[Centre::NeckFlexion], deg(25) - trunk, deg(0.5));
  EXPECT_NEAR(of(body)[Centre::NeckSideBend], 0.0, 1e-6);
}

TEST(Measures, AreUnmovedByTurningAndMovingTheWorld) {
  const auto body =
      with_trunk_turned(standing_person(), deg(33), Eigen::Vector3d(1, 0.3, 0.2).normalized());
  const auto moved = to_world(Eigen::Translation3d(3, 0, -2) * Eigen::Isometry3d(Eigen::AngleAxisd(
                                                                   2.1, Eigen::Vector3d::UnitY())),
                              Skeleton<SensorSpace>{body.joints});
  const auto a = of(body);
  const auto b = of(moved);
  for (std::size_t m = 0; m < kMeasures; ++m) {
    if (std::isnan(a.values[m]))
      EXPECT_TRUE(std::isnan(b.values[m])) << name_of(m);
    else
      EXPECT_NEAR(a.values[m], b.values[m], 1e-9) << name_of(m);
  }
}

TEST(Measures, OfTheMirroredBodyAreMirrored) {
  const auto body =
      with_trunk_turned(standing_person(), deg(33), Eigen::Vector3d(1, 0.3, 0.2).normalized());
  Skeleton<WorldSpace> mirrored = body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& from = body[mirror(static_cast<JointId>(j))].position;
    mirrored.joints[j].position = {-from.x(), from.y(), from.z()};
  }
  const auto a = of(body);
  const auto b = of(mirrored);
  for (const Centre flips : {Centre::TrunkSideBend, Centre::TrunkTwist, Centre::NeckSideBend})
    EXPECT_NEAR(a[flips], -b[flips], 1e-9);
  EXPECT_NEAR(a[Centre::TrunkFlexion], b[Centre::TrunkFlexion], 1e-9);
  for (std::size_t l = 0; l < kLimbs; ++l)
    EXPECT_NEAR(a.at(static_cast<Limb>(l), Side::Left), b.at(static_cast<Limb>(l), Side::Right),
                1e-9);
}

TEST(Measures, OfNobodyAreUnknownAndHaveDistinctNames) {
  const auto nobody = posture_of(Skeleton<WorldSpace>{}).measures;
  for (std::size_t m = 0; m < kMeasures; ++m) {
    EXPECT_TRUE(std::isnan(nobody.values[m]));
    for (std::size_t n = 0; n < m; ++n) EXPECT_NE(name_of(m), name_of(n));
  }
  EXPECT_EQ(name_of(index_of(Limb::ElbowFlexion, Side::Right)), "rightElbowFlexion");
}

}  // namespace
}  // namespace chorus::posture

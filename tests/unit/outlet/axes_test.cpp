// One asymmetric pose through every protocol's axes, compared with hand-computed numbers.
#include "fusion-server/outlet/axes.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/matchers.h"

namespace chorus::outlet {
namespace {

using testing::VectorNear;

const Eigen::Vector3d kPlace(1.0, 2.0, 3.0);

Eigen::Quaterniond turned_by(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(deg(degrees), axis));
}

Eigen::Quaterniond asymmetric() {
  return turned_by(20, Eigen::Vector3d::UnitX()) * turned_by(40, Eigen::Vector3d::UnitY()) *
         turned_by(-70, Eigen::Vector3d::UnitZ());
}

TEST(Axes, PositionsGoWhereTheFormatsSay) {
  EXPECT_THAT(vrpn_axes().position(kPlace), VectorNear(kPlace, 1e-12));
  EXPECT_THAT(dtrack_axes().position(kPlace), VectorNear(Eigen::Vector3d(1000, -3000, 2000), 1e-9));
  EXPECT_THAT(trackd_axes().position(kPlace),
              VectorNear(Eigen::Vector3d(3.280840, 6.561680, 9.842520), 1e-5));
  EXPECT_THAT(unity_axes().position(kPlace), VectorNear(Eigen::Vector3d(1, 2, -3), 1e-12));
  EXPECT_THAT(xsens_axes().position(kPlace), VectorNear(Eigen::Vector3d(3, 1, 2), 1e-12));
}

TEST(Axes, OnlyUnityIsLeftHanded) {
  for (const Axes* right : {&vrpn_axes(), &dtrack_axes(), &trackd_axes(), &xsens_axes()}) {
    EXPECT_NEAR(right->target_from_world.determinant(), 1.0, 1e-12);
  }
  EXPECT_NEAR(unity_axes().target_from_world.determinant(), -1.0, 1e-12);
}

TEST(Axes, UnityTurnsAsSlimeVrAndGodotDo) {
  const Eigen::Quaterniond q = asymmetric();
  const Eigen::Quaterniond expected(q.w(), -q.x(), -q.y(), q.z());
  EXPECT_LT(angular_distance(unity_axes().quaternion(q), expected), 1e-9);
}

TEST(Axes, XsensPermutesTheVectorPart) {
  const Eigen::Quaterniond q = asymmetric();
  const Eigen::Quaterniond expected(q.w(), q.z(), q.x(), q.y());
  EXPECT_LT(angular_distance(xsens_axes().quaternion(q), expected), 1e-9);
}

TEST(Axes, AYawTurnsAboutTheUpAxisOfEveryTarget) {
  const Eigen::Quaterniond yaw = turned_by(30, Eigen::Vector3d::UnitY());
  EXPECT_LT(
      angular_distance(dtrack_axes().quaternion(yaw), turned_by(30, Eigen::Vector3d::UnitZ())),
      1e-9);
  EXPECT_LT(angular_distance(xsens_axes().quaternion(yaw), turned_by(30, Eigen::Vector3d::UnitZ())),
            1e-9);
  // Left-handed: the same rotation has the opposite sign.
  EXPECT_LT(
      angular_distance(unity_axes().quaternion(yaw), turned_by(-30, Eigen::Vector3d::UnitY())),
      1e-9);
}

TEST(Axes, APointOfTheJointLandsWhereItsPoseSays) {
  const Eigen::Vector3d x_in_joint(0.1, 0.2, 0.3);
  for (const Axes* axes :
       {&vrpn_axes(), &dtrack_axes(), &trackd_axes(), &unity_axes(), &xsens_axes()}) {
    const Eigen::Vector3d x_in_world = kPlace + asymmetric() * x_in_joint;
    const Eigen::Vector3d through_pose =
        axes->position(kPlace) + axes->rotation(asymmetric()) * axes->position(x_in_joint);
    EXPECT_THAT(through_pose, VectorNear(axes->position(x_in_world), 1e-9));
  }
}

TEST(Axes, QuaternionsHaveNonNegativeW) {
  const Eigen::Quaterniond q = turned_by(300, Eigen::Vector3d(1, 2, 3).normalized());
  EXPECT_GE(unity_axes().quaternion(q).w(), 0.0);
  EXPECT_GE(vrpn_axes().quaternion(Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z())).w(), 0.0);
}

struct Angles {
  const char* name;
  Eigen::Vector3d (*of)(const Eigen::Matrix3d&);
  Eigen::Vector3d given;      ///< Angles that `of` must return [deg]
  Eigen::Quaterniond turned;  ///< The rotation that these angles describe
};

class EulerAngles : public ::testing::TestWithParam<Angles> {};

TEST_P(EulerAngles, AreThoseTheRotationWasMadeOf) {
  const Angles& a = GetParam();
  EXPECT_THAT(a.of(a.turned.toRotationMatrix()), VectorNear(a.given * deg(1), 1e-7));
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

INSTANTIATE_TEST_SUITE_P(
    Protocols, EulerAngles,
    ::testing::Values(
        Angles{"dtrack",
               dtrack_angles,
               {20, 40, -70},
               turned_by(20, kX) * turned_by(40, kY) * turned_by(-70, kZ)},
        Angles{"dtrack_gimbal", dtrack_angles, {20, 90, 0}, turned_by(20, kX) * turned_by(90, kY)},
        Angles{"trackd",
               trackd_angles,
               {150, 40, -70},
               turned_by(150, kY) * turned_by(40, kX) * turned_by(-70, kZ)},
        Angles{
            "trackd_gimbal", trackd_angles, {35, -90, 0}, turned_by(35, kY) * turned_by(-90, kX)},
        Angles{"unity",
               unity_angles,
               {40, 150, -70},
               turned_by(150, kY) * turned_by(40, kX) * turned_by(-70, kZ)}),
    [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace chorus::outlet

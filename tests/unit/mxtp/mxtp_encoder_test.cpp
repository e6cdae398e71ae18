// MXTP02 read by a decoder written from the format's table, not from the encoder.
#include "fusion-server/mxtp/mxtp_encoder.h"

#include <array>
#include <cstring>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/motion/mvnx.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::mxtp {
namespace {

using chorus::testing::VectorNear;

struct Read {
  explicit Read(const std::vector<char>& bytes) : b(bytes) {}
  [[nodiscard]] std::uint32_t u(std::size_t at, std::size_t n) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < n; ++i)
      value = value * 256 + static_cast<unsigned char>(b.at(at + i));
    return value;
  }
  [[nodiscard]] double f(std::size_t at) const {
    const std::uint32_t bits = u(at, 4);
    float value = 0;
    std::memcpy(&value, &bits, 4);
    return static_cast<double>(value);
  }
  [[nodiscard]] std::size_t item(std::uint32_t segment) const { return 24 + 32 * (segment - 1); }
  [[nodiscard]] Eigen::Vector3d place(std::uint32_t segment) const {
    const std::size_t at = item(segment) + 4;
    return {f(at), f(at + 4), f(at + 8)};
  }
  [[nodiscard]] Eigen::Quaterniond turn(std::uint32_t segment) const {
    const std::size_t at = item(segment) + 16;
    return {f(at), f(at + 4), f(at + 8), f(at + 12)};
  }
  const std::vector<char>& b;
};

outlet::TrackerFrame frame_of(const Skeleton<WorldSpace>& skeleton) {
  Snapshot s;
  s.sequence = 0x1'0000'0007;  // more than the field holds
  s.instant = from_unix_ns(1'700'000'000'123'000'000);
  s.bodies.resize(1);
  s.bodies[0].slot = 0;
  s.bodies[0].skeleton = skeleton;
  outlet::TrackerState state(3);
  return state.advance(s);
}

constexpr std::uint32_t kPelvis = 1, kL5 = 2, kRightHand = 11, kLeftHand = 15, kToe = 23;

TEST(Mxtp, HeaderSaysWhatFollows) {
  const outlet::TrackerFrame frame = frame_of(chorus::testing::standing_person({0, 0, 0}));
  const auto bytes = encode(frame, frame.bodies.at(0));
  ASSERT_EQ(bytes.size(), 760u);
  const Read read(bytes);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 6), "MXTP02");
  EXPECT_EQ(read.u(6, 4), 7u);
  EXPECT_EQ(read.u(10, 1), 0x80u);
  EXPECT_EQ(read.u(11, 1), 23u);
  EXPECT_EQ(read.u(12, 4), static_cast<std::uint32_t>(1'700'000'000'123ULL));
  EXPECT_EQ(read.u(16, 1), 0u);
  EXPECT_EQ(read.u(17, 1), 23u);
  EXPECT_EQ(read.u(22, 2), 736u);
  for (std::uint32_t id = 1; id <= 23; ++id) EXPECT_EQ(read.u(read.item(id), 4), id);
}

TEST(Mxtp, ThingsInHandsFollowAsProps) {
  outlet::TrackerFrame frame = frame_of(chorus::testing::standing_person({0, 0, 0}));
  frame.props.resize(7);
  for (outlet::TrackerProp& prop : frame.props) prop.pose.tracked = true;
  frame.props[0].slot = 2;  // somebody else's
  frame.props[1].pose.tracked = false;
  frame.props[2].pose.position = {1, 2, 3};
  frame.props[2].pose.orientation = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY());
  const auto bytes = encode(frame, frame.bodies.at(0));
  ASSERT_EQ(bytes.size(), 760u + 4 * 32) << "MVN has four";
  const Read read(bytes);
  EXPECT_EQ(read.u(11, 1), 27u);
  EXPECT_EQ(read.u(17, 1), 23u);
  EXPECT_EQ(read.u(18, 1), 4u);
  EXPECT_EQ(read.u(22, 2), 27u * 32);
  for (std::uint32_t id = 24; id <= 27; ++id) EXPECT_EQ(read.u(read.item(id), 4), id);
  EXPECT_THAT(read.place(24), VectorNear(Eigen::Vector3d(3, 1, 2), 1e-5));
  const Eigen::Quaterniond about_up(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(read.turn(24).angularDistance(about_up), 0.0, 1e-5);
}

TEST(Mxtp, PlacesAreZUpAndXForward) {
  Skeleton<WorldSpace> body = chorus::testing::standing_person({0, 0, 0});
  body[JointId::SpineBase].position = {1, 2, 3};
  body[JointId::SpineMid].position = {1, 2.3, 3};
  body[JointId::HandRight].position = {9, 9, 9};
  body[JointId::WristRight].position = {4, 5, 6};
  body[JointId::WristLeft].position = {7, 8, 9};
  const outlet::TrackerFrame frame = frame_of(body);
  const auto bytes = encode(frame, frame.bodies.at(0));
  const Read read(bytes);
  EXPECT_THAT(read.place(kPelvis), VectorNear(Eigen::Vector3d(3, 1, 2), 1e-5));
  EXPECT_THAT(read.place(kL5), VectorNear(Eigen::Vector3d(3, 1, 2.1), 1e-5));
  EXPECT_THAT(read.place(kRightHand), VectorNear(Eigen::Vector3d(6, 4, 5), 1e-5));
  EXPECT_THAT(read.place(kLeftHand), VectorNear(Eigen::Vector3d(9, 7, 8), 1e-5));
}

constexpr std::uint32_t kNeck = 6, kHead = 7;

TEST(Mxtp, TheHeadIsAsFarBeyondTheNeckAsThatIsFromTheShoulders) {
  Skeleton<WorldSpace> body = chorus::testing::standing_person({0, 0, 0});
  body[JointId::SpineShoulder].position = {0.1, 1.4, 2.0};
  body[JointId::Neck].position = {0.1, 1.47, 2.02};
  const outlet::TrackerFrame frame = frame_of(body);
  const auto bytes = encode(frame, frame.bodies.at(0));
  EXPECT_THAT(Read(bytes).place(kNeck), VectorNear(Eigen::Vector3d(2.0, 0.1, 1.4), 1e-5));
  EXPECT_THAT(Read(bytes).place(kHead), VectorNear(Eigen::Vector3d(2.04, 0.1, 1.54), 1e-5));
}

TEST(Mxtp, TheHeadOfWhomOnlyPartOfTheNeckIsSeenStaysOnIt) {
  const auto place_without = [](JointId missing) {
    Skeleton<WorldSpace> body = chorus::testing::standing_person({0, 0, 0});
    body[JointId::SpineMid].position = {0, 1.2, 0};
    body[JointId::SpineShoulder].position = {0, 1.4, 0};
    body[JointId::Neck].position = {0, 1.47, 0};
    chorus::testing::hide(body[missing]);
    const outlet::TrackerFrame frame = frame_of(body);
    return Read(encode(frame, frame.bodies.at(0))).place(kHead).z();
  };
  EXPECT_NEAR(place_without(JointId::SpineShoulder), 1.47, 1e-5);
  EXPECT_NEAR(place_without(JointId::Neck), 1.4, 1e-5);
}

/// Makes an MVNX file from the content of a datagram.  The file states a single point, jC1Head,
/// the end of the neck: it lies on the neck's z axis, as far away as the head's origin.
motion::Mvnx file_of(const std::vector<char>& bytes) {
  constexpr std::array kLabels{"Pelvis",
                               "L5",
                               "L3",
                               "T12",
                               "T8",
                               "Neck",
                               "Head",
                               "RightShoulder",
                               "RightUpperArm",
                               "RightForeArm",
                               "RightHand",
                               "LeftShoulder",
                               "LeftUpperArm",
                               "LeftForeArm",
                               "LeftHand",
                               "RightUpperLeg",
                               "RightLowerLeg",
                               "RightFoot",
                               "RightToe",
                               "LeftUpperLeg",
                               "LeftLowerLeg",
                               "LeftFoot",
                               "LeftToe"};
  motion::Mvnx file;
  motion::MvnxFrame frame;
  for (std::uint32_t id = 1; id <= kLabels.size(); ++id) {
    file.segments.push_back({kLabels.at(id - 1), {}});
    frame.positions.push_back(Read(bytes).place(id));
    frame.orientations.push_back(Read(bytes).turn(id));
  }
  const Eigen::Vector3d along = Read(bytes).place(kHead) - Read(bytes).place(kNeck);
  file.segments.at(kNeck - 1).points = {{"jC1Head", {0, 0, along.norm()}}};
  file.frames.push_back(frame);
  return file;
}

TEST(Mxtp, IsReadBackByOurOwnImportOfMvn) {
  using enum JointId;
  outlet::TrackerBody body = outlet::testing::t_pose();
  outlet::testing::turn(body, {Neck, Head}, SpineShoulder, outlet::testing::about_x(25));
  outlet::testing::turn(body, outlet::testing::kLeftArm, ShoulderLeft,
                        outlet::testing::about_z(60));
  outlet::testing::move(body, {0.5, 0, 2}, 130);
  const auto motion = motion::motion_from_mvnx(file_of(encode({}, body)));
  ASSERT_THAT(motion, chorus::testing::IsOk());
  for (const JointId id : {SpineBase, SpineMid, SpineShoulder, Neck, ShoulderLeft, ElbowLeft,
                           WristLeft, ShoulderRight, ElbowRight, WristRight, HipLeft, KneeLeft,
                           AnkleLeft, FootLeft, HipRight, KneeRight, AnkleRight, FootRight}) {
    EXPECT_THAT(motion->frames.at(0)[id].position, VectorNear(body[id].position, 1e-5))
        << name_of(id);
  }
}

/// The datagram of a pose that looks along our +z, which is Xsens' +x.
std::vector<char> facing_x(outlet::TrackerBody body, double yaw_degrees = 0) {
  outlet::testing::move(body, {0, 0, 0}, 180 + yaw_degrees);
  return encode({}, body);
}

TEST(Mxtp, ATPoseThatLooksAlongXHasIdentitiesOnly) {
  const auto bytes = facing_x(outlet::testing::t_pose());
  ASSERT_EQ(bytes.size(), 760u);
  for (std::uint32_t id = 1; id <= 23; ++id) {
    EXPECT_LT(angular_distance(Read(bytes).turn(id), Eigen::Quaterniond::Identity()), 1e-3) << id;
  }
  EXPECT_GT(Read(bytes).place(kLeftHand).y(), 0.5) << "the left is at +y";
}

TEST(Mxtp, AYawIsATurnAboutZ) {
  const auto bytes = facing_x(outlet::testing::t_pose(), 30);
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(deg(30), Eigen::Vector3d::UnitZ()));
  for (const std::uint32_t id : {kPelvis, kRightHand, kToe})
    EXPECT_LT(angular_distance(Read(bytes).turn(id), expected), 1e-3) << id;
}

TEST(Mxtp, ALoweredArmAndARaisedLegTurnTheirSegmentsAlone) {
  using enum JointId;
  outlet::TrackerBody body = outlet::testing::t_pose();
  outlet::testing::turn(body, outlet::testing::kLeftArm, ShoulderLeft,
                        outlet::testing::about_z(80));
  outlet::testing::turn(body, {KneeLeft, AnkleLeft, FootLeft}, HipLeft,
                        outlet::testing::about_x(40));
  const auto bytes = facing_x(body);
  // The left arm moves from +y towards -z; the leg swings from -z towards +x.
  const Eigen::Quaterniond lowered(Eigen::AngleAxisd(deg(-80), Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond raised(Eigen::AngleAxisd(deg(-40), Eigen::Vector3d::UnitY()));
  constexpr std::uint32_t kLeftUpperArm = 13, kRightUpperArm = 9, kLeftUpperLeg = 20;
  EXPECT_LT(angular_distance(Read(bytes).turn(kLeftUpperArm), lowered), 1e-3);
  EXPECT_LT(angular_distance(Read(bytes).turn(kLeftUpperLeg), raised), 1e-3);
  for (const std::uint32_t id : {kPelvis, kRightUpperArm})
    EXPECT_LT(angular_distance(Read(bytes).turn(id), Eigen::Quaterniond::Identity()), 1e-3) << id;
}

TEST(Mxtp, AnUnseenLimbHangsAtItsParentAndNothingIsNotANumber) {
  Skeleton<WorldSpace> body = chorus::testing::standing_person({0, 0, 0});
  body[JointId::AnkleLeft].position = {1, 0.1, 2};
  chorus::testing::hide(body[JointId::FootLeft]);
  body[JointId::FootLeft].position.setConstant(std::nan(""));
  const outlet::TrackerFrame frame = frame_of(body);
  const auto bytes = encode(frame, frame.bodies.at(0));
  EXPECT_THAT(Read(bytes).place(kToe), VectorNear(Eigen::Vector3d(2, 1, 0.1), 1e-5));
}

TEST(Mxtp, ABodyWithoutPelvisOrHeadIsNotSent) {
  for (const JointId missing : {JointId::SpineBase, JointId::Head}) {
    Skeleton<WorldSpace> body = chorus::testing::standing_person({0, 0, 0});
    chorus::testing::hide(body[missing]);
    const outlet::TrackerFrame frame = frame_of(body);
    EXPECT_TRUE(encode(frame, frame.bodies.at(0)).empty());
  }
}

}  // namespace
}  // namespace chorus::mxtp

#include "common/motion/mvnx.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/base/units.h"
#include "common/motion/bvh.h"
#include "tests/support/matchers.h"

namespace chorus::motion {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::RotationNear;
using chorus::testing::VectorNear;
using ::testing::HasSubstr;

/// Pelvis, left upper and lower arm; the person faces +x, the upper arm hangs down, the forearm
/// points forwards.
constexpr std::string_view kSuit = R"(<?xml version="1.0"?>
<mvnx version="4">
 <mvn build="x"/>
 <subject label="Sub" frameRate="60" segmentCount="3">
  <segments>
   <segment label="Pelvis" id="1"><points><point label="p"><pos_b>0 0 0.1</pos_b></point></points></segment>
   <segment label="LeftUpperArm" id="2"><points/></segment>
   <segment label="LeftForeArm" id="3"><points/></segment>
  </segments>
  <sensors><sensor label="Pelvis"/></sensors>
  <frames>
   <frame time="0" type="identity"><orientation>1 0 0 0</orientation></frame>
   <frame time="0" index="0" type="normal">
    <orientation>1 0 0 0 0.70710678 -0.70710678 0 0 0.5 -0.5 0.5 -0.5</orientation>
    <position>0.1 0.2 0.9 0.1 0.4 1.4 0.1 0.4 1.1</position>
    <sensorOrientation>0 1 0 0</sensorOrientation>
    <velocity>nonsense is passed over</velocity>
   </frame>
   <frame time="17" index="1" type="normal">
    <orientation>1 0 0 0 1 0 0 0 1 0 0 0</orientation>
    <position>0 0 0.9 0 0.2 1.4 0 0.5 1.4</position>
   </frame>
  </frames>
 </subject>
</mvnx>)";

std::string mvnx_with(std::string_view from, std::string_view to) {
  std::string text(kSuit);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Mvnx, ReadsSegmentsAndNormalFramesOnly) {
  const auto mvnx = parse_mvnx(kSuit, "suit.mvnx");
  ASSERT_THAT(mvnx, IsOk());
  EXPECT_EQ(mvnx->rate_hz, 60.0);
  ASSERT_EQ(mvnx->segments.size(), 3u);
  EXPECT_EQ(mvnx->segments[0].points[0].in_segment, Eigen::Vector3d(0, 0, 0.1));
  ASSERT_EQ(mvnx->frames.size(), 2u);
  EXPECT_NEAR(mvnx->frames[1].time, 1.0 / 60.0, 1e-12) << "by its index, which is not cut to ms";
  EXPECT_NEAR(mvnx->frames[0].orientations[1].w(), std::sqrt(0.5), 1e-7) << "w first";
  ASSERT_EQ(mvnx->frames[0].sensor_orientations.size(), 1u);
  EXPECT_EQ(mvnx->frames[0].sensor_orientations[0].x(), 1.0);
}

TEST(Mvnx, FingersAreReadByTheirPathAndLeftOut) {
  const std::string text = mvnx_with(
      "  <sensors>",
      "  <fingerTrackingSegmentsLeft><segment label=\"LeftCarpus\"><points><point label=\"x\">"
      "<pos_b>9 9 9</pos_b></point></points></segment></fingerTrackingSegmentsLeft>\n  <sensors>");
  const auto mvnx = parse_mvnx(text, "gloves.mvnx");
  ASSERT_THAT(mvnx, IsOk());
  EXPECT_EQ(mvnx->segments.size(), 3u);
  EXPECT_TRUE(mvnx->fingers);
}

TEST(Mvnx, LostFramesLeaveAGapInTime) {
  const auto mvnx =
      parse_mvnx(mvnx_with("time=\"17\" index=\"1\"", "time=\"200\" index=\"12\""), "a");
  ASSERT_THAT(mvnx, IsOk());
  EXPECT_NEAR(mvnx->frames[1].time, 0.2, 1e-12);
  EXPECT_EQ(motion_from_mvnx(*mvnx)->times, (std::vector<double>{0.0, mvnx->frames[1].time}));
  const auto odd =
      parse_mvnx(mvnx_with("time=\"17\" index=\"1\"", "time=\"200\" index=\"1\""), "b");
  EXPECT_NEAR(odd->frames[1].time, 0.2, 1e-12) << "where they disagree, the time counts";
}

TEST(Mvnx, AheadLeftUpBecomesOurWorld) {
  const auto motion = motion_from_mvnx(parse_mvnx(kSuit, "suit.mvnx").value());
  ASSERT_THAT(motion, IsOk());
  const auto& body = motion->frames[0];
  // The file's forward, left and up are our z, x and y, because the person faces our +z.
  EXPECT_THAT(body[JointId::SpineBase].position, VectorNear(Eigen::Vector3d(0.2, 0.9, 0.1), 1e-9));
  EXPECT_THAT(body[JointId::ShoulderLeft].position,
              VectorNear(Eigen::Vector3d(0.4, 1.4, 0.1), 1e-9));
  EXPECT_FALSE(body[JointId::Head].seen());
}

TEST(Mvnx, SegmentsTurnJointsSoThatYLiesAlongTheBone) {
  const auto motion = motion_from_mvnx(parse_mvnx(kSuit, "suit.mvnx").value()).value();
  const Joint& elbow = motion.frames[0][JointId::ElbowLeft];  // the end of the upper arm
  EXPECT_THAT(Eigen::Vector3d(elbow.orientation * Eigen::Vector3d::UnitY()),
              VectorNear(-Eigen::Vector3d::UnitY(), 1e-6));
  EXPECT_THAT(Eigen::Vector3d(elbow.orientation * Eigen::Vector3d::UnitZ()),
              VectorNear(Eigen::Vector3d::UnitZ(), 1e-6))
      << "its front still faces ahead";
  // In the T-pose the bone points along the arm to the left, and its front forwards.
  const Joint& straight = motion.frames[1][JointId::ElbowLeft];
  EXPECT_THAT(Eigen::Vector3d(straight.orientation * Eigen::Vector3d::UnitY()),
              VectorNear(Eigen::Vector3d::UnitX(), 1e-9));
}

TEST(MvnxHostile, LiesAreErrorsWithALine) {
  const auto wrong = [](const std::string& text) { return parse_mvnx(text, "suit.mvnx"); };
  EXPECT_THAT(wrong(mvnx_with("frameRate=\"60\"", "frameRate=\"0\"")),
              FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(mvnx_with("0.1 0.2 0.9 ", "0.1 0.2 ")), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(mvnx_with("0.1 0.2 0.9 ", "0.1 nan 0.9 ")), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(mvnx_with("0.1 0.2 0.9 ", "0.1 1e9 0.9 ")), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(mvnx_with("<orientation>1 0 0 0 0.7", "<orientation>3 0 0 0 0.7")),
              FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(mvnx_with("<segment label=\"LeftForeArm\" id=\"3\"><points/></segment>", "")),
              FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(mvnx_with("<sensors>", "<subject frameRate=\"1\"/><sensors>")),
              FailsWith(ErrorCode::Unsupported));
  EXPECT_THAT(wrong(mvnx_with("</mvnx>", "")), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong("<mvnx/>"), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(wrong(""), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(to_string(wrong(mvnx_with("0.1 0.2 0.9 ", "x ")).error()), HasSubstr("suit.mvnx:15"));
  EXPECT_THAT(motion_from_mvnx(parse_mvnx(mvnx_with("\"Pelvis\" id", "\"Pelvi\" id"), "x").value()),
              FailsWith(ErrorCode::Unsupported));
}

TEST(MvnxHostile, EntitiesAndDeepNestingAreRefused) {
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE m [<!ENTITY a \"aaaa\"><!ENTITY b "
      "\"&a;&a;\">]><mvnx>&b;</mvnx>";
  EXPECT_THAT(parse_mvnx(bomb, "bomb"), FailsWith(ErrorCode::Unsupported));
  const std::string outside =
      "<!DOCTYPE m [<!ENTITY a SYSTEM \"file:///etc/passwd\">]><mvnx>&a;</mvnx>";
  EXPECT_THAT(parse_mvnx(outside, "outside"), FailsWith(ErrorCode::Unsupported));
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(parse_mvnx(deep, "deep"), FailsWith(ErrorCode::TooLarge));
}

TEST(MvnxHostile, EveryTruncationIsAnError) {
  for (std::size_t size = 0; size + 1 < kSuit.size(); ++size)
    EXPECT_FALSE(parse_mvnx(kSuit.substr(0, size), "cut.mvnx")) << size;
}

TEST(RealMvnx, AgreesWithTheBvhTheSuitsSoftwareMadeOfTheSameTake) {
  const char* named = std::getenv("CHORUS_SHARED");
  const auto folder =
      std::filesystem::path(named != nullptr ? named : "../shared") / "data/xsens_mvnx_bvh";
  const auto text = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string xml = text("test_mocap.mvnx");
  if (xml.empty()) GTEST_SKIP() << "runs where ../shared/data stands beside the checkout";
  const auto suit = motion_from_mvnx(parse_mvnx(xml, "test_mocap.mvnx").value()).value();
  const auto bvh =
      motion_from_bvh(parse_bvh(text("test_mocap.bvh"), "test_mocap.bvh").value()).value();
  ASSERT_EQ(suit.frames.size(), bvh.frames.size());
  // Frame 0 of the BVH is a T-pose.  Its space may be shifted: distances within the body count.
  for (std::size_t f = 1; f < suit.frames.size(); f += 10) {
    const auto length = [&](const Motion& motion, JointId a, JointId b) {
      return (motion.frames[f][a].position - motion.frames[f][b].position).norm();
    };
    for (const auto& [a, b] : {std::pair{JointId::HipLeft, JointId::AnkleLeft},
                               std::pair{JointId::AnkleLeft, JointId::AnkleRight},
                               std::pair{JointId::WristLeft, JointId::KneeRight},
                               std::pair{JointId::WristRight, JointId::ShoulderLeft}})
      EXPECT_NEAR(length(suit, a, b), length(bvh, a, b), mm(15)) << f;
    const Eigen::Vector3d left = suit.frames[f][JointId::ShoulderLeft].position -
                                 suit.frames[f][JointId::ShoulderRight].position;
    const Eigen::Vector3d left_of_bvh = bvh.frames[f][JointId::ShoulderLeft].position -
                                        bvh.frames[f][JointId::ShoulderRight].position;
    EXPECT_THAT(left, VectorNear(left_of_bvh, mm(20))) << "the same way round in both worlds";
  }
}

}  // namespace
}  // namespace chorus::motion

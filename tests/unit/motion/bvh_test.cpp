#include "common/motion/bvh.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/body/bones.h"
#include "common/motion/motion.h"

namespace chorus::motion {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kArm = R"(HIERARCHY
ROOT Hips
{
	OFFSET 0 0 0
	CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
	JOINT Arm {
		OFFSET 0 10 0
		CHANNELS 3 Zrotation Xrotation Yrotation
		End Site
		{
			OFFSET 0 20 0
		}
	}
}
MOTION
Frames: 2
Frame Time: 0.05
0 100 0 0 0 0 0 0 0
50 100 0 90 90 0 0 0 0
)";

std::string with_replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Bvh, ReadsHierarchyAndFramesInMetres) {
  const auto bvh = parse_bvh(kArm, "arm.bvh");
  ASSERT_TRUE(bvh) << to_string(bvh.error());
  ASSERT_EQ(bvh->joints.size(), 3u);
  EXPECT_EQ(bvh->joints[2].name, "Arm End");
  EXPECT_EQ(bvh->frames.size(), 2u);
  EXPECT_DOUBLE_EQ(bvh->frame_time, 0.05);
  const auto rest = joint_positions(*bvh, 0);
  EXPECT_TRUE(rest[2].isApprox(Eigen::Vector3d(0, 1.3, 0), 1e-12));
}

TEST(Bvh, TurnsInTheListedOrder) {
  const auto bvh = parse_bvh(kArm, "arm.bvh").value();
  // R = Rz(90) Rx(90): x takes +y to +z, and z leaves it there.
  const auto posed = joint_positions(bvh, 1);
  EXPECT_TRUE(posed[1].isApprox(Eigen::Vector3d(0.5, 1.0, 0.1), 1e-9)) << posed[1].transpose();
}

TEST(Bvh, RefusesBrokenFilesAndSaysWhere) {
  const std::array<std::string_view, 4> cases[] = {
      {"HIERARCHY", "HIERARCHIE", "b:1", "expected HIERARCHY"},
      {"OFFSET 0 10 0", "OFFSET 0 10", "b:7", "expected 3 numbers"},
      {"CHANNELS 3 Z", "CHANNELS 4 Z", "b:8", "does not match"},
      {"CHANNELS 3 Zrotation", "CHANNELS 3 Wrotation", "b:8", "unknown channel"},
      {"Frames: 2", "Frames: many", "b:16", "expected 'Frames: N'"},
      {"Frame Time: 0.05", "Frame Time: 0", "b:17", "above zero"},
      {"}\nMOTION", "MOTION", "b:14", "not closed"},
      {"JOINT Arm", "LIMB Arm", "b:6", "unknown keyword"},
  };
  for (const auto& [from, to, line, why] : cases) {
    const auto parsed = parse_bvh(with_replaced(std::string(kArm), from, to), "b");
    ASSERT_FALSE(parsed) << why;
    EXPECT_EQ(parsed.error().context, line) << parsed.error().message;
    EXPECT_THAT(parsed.error().message, HasSubstr(std::string(why)));
  }
}

TEST(Bvh, TheFramesThatAreThereCountNotTheirNumber) {
  for (const char* number : {"Frames: 3", "Frames: 1", "Frames: 0", "Frames:\t9999999"}) {
    const auto parsed = parse_bvh(with_replaced(std::string(kArm), "Frames: 2", number), "b");
    ASSERT_TRUE(parsed) << number;
    EXPECT_EQ(parsed->frames.size(), 2u);
    ASSERT_EQ(parsed->notes.size(), 1u);
    EXPECT_THAT(parsed->notes[0], HasSubstr("and holds 2, which were read"));
  }
}

TEST(Bvh, ACutLastLineIsLeftOutAndABrokenOneShowsNobody) {
  const auto cut = parse_bvh(kArm.substr(0, kArm.size() - 10), "cut.bvh");
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->frames.size(), 1u);
  EXPECT_THAT(cut->notes.at(0), HasSubstr("cut off"));
  const std::string text = with_replaced(std::string(kArm), "0 100 0 0 0 0 0 0 0", "0 nan 0 0");
  const auto broken = parse_bvh(text, "broken.bvh");
  ASSERT_TRUE(broken);
  ASSERT_EQ(broken->frames.size(), 2u) << "the second frame keeps its time";
  EXPECT_TRUE(broken->frames[0].empty());
  EXPECT_THAT(broken->notes.at(0), HasSubstr("1 frames cannot be read"));
}

TEST(Bvh, NamesMayHaveBlanksAndKeywordsAnyCase) {
  std::string text = with_replaced(std::string(kArm), "JOINT Arm", "Joint Bip01 L Arm");
  text = with_replaced(text, "CHANNELS 3 Zrotation", "CHANNELS 3 ZRotation");
  text = "\xEF\xBB\xBF" + with_replaced(text, "Frame Time: 0.05", "Frame Time: 0,05");
  const auto parsed = parse_bvh(text, "odd.bvh");
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(parsed->joints[1].name, "Bip01 L Arm");
  EXPECT_DOUBLE_EQ(parsed->frame_time, 0.05);
}

TEST(Bvh, NestingIsBounded) {
  std::string deep = "HIERARCHY\nROOT a\n{\n";
  for (int i = 0; i < 20000; ++i) deep += "JOINT b\n{\n";
  const auto parsed = parse_bvh(deep, "deep.bvh");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, ErrorCode::TooLarge);
}

TEST(Bvh, AnyCutOrFlippedByteIsHandled) {
  for (std::size_t i = 0; i < kArm.size(); ++i) {
    std::string text(kArm);
    text[i] = static_cast<char>(text[i] ^ 0x15);
    const auto flipped = parse_bvh(text, "flipped.bvh");
    EXPECT_TRUE(flipped || !flipped.error().message.empty());
    const auto cut = parse_bvh(kArm.substr(0, i), "cut.bvh");
    EXPECT_TRUE(!cut || !cut->notes.empty() || i + 2 >= kArm.size()) << "cut after " << i;
  }
}

TEST(BvhMotion, AFileWithoutABodyIsRefused) {
  const auto motion = motion_from_bvh(parse_bvh(kArm, "arm.bvh").value());
  ASSERT_FALSE(motion);
  EXPECT_EQ(motion.error().code, ErrorCode::Unsupported);
}

/// Real files of several dialects; they may not be distributed, so they are read from elsewhere.
struct RealDialect {
  const char* path;
  double metres_per_unit;
};

class RealBvh : public ::testing::TestWithParam<RealDialect> {};

TEST_P(RealBvh, LooksLikeAPerson) {
  const auto path = std::filesystem::path("../shared/data") / GetParam().path;
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << "runs where " << path << " is there";
  std::stringstream text;
  text << file.rdbuf();
  const auto bvh = parse_bvh(text.str(), path.filename().string(), GetParam().metres_per_unit);
  ASSERT_TRUE(bvh) << to_string(bvh.error());
  const auto motion = motion_from_bvh(*bvh);
  ASSERT_TRUE(motion) << to_string(motion.error());
  // People bend and crouch in some of these files, so only one frame must show an upright person;
  // bones must keep their lengths in all frames.
  int upright = 0;
  const auto length = [](const Skeleton<WorldSpace>& body, JointId a, JointId b) {
    return (body[a].position - body[b].position).norm();
  };
  const double thigh = length(motion->frames[0], JointId::HipLeft, JointId::KneeLeft);
  EXPECT_NEAR(thigh, 0.42, 0.1);
  for (const auto& body : motion->frames) {
    const auto y = [&](JointId id) { return body[id].position.y(); };
    const double tall = y(JointId::Head) - y(JointId::AnkleLeft);
    upright += tall > 1.1 && tall < 1.9 && y(JointId::Neck) > y(JointId::SpineMid) &&
               y(JointId::SpineMid) > y(JointId::SpineBase) &&
               y(JointId::KneeRight) > y(JointId::AnkleRight);
    ASSERT_NEAR(length(body, JointId::HipLeft, JointId::KneeLeft), thigh, 0.02);
  }
  EXPECT_GT(upright, 10);
}

INSTANTIATE_TEST_SUITE_P(
    Dialects, RealBvh,
    ::testing::Values(RealDialect{"bvh_misc/tests/test_freebvh.bvh", 0.01},
                      RealDialect{"bvh_misc/tests/test_mocapbank.bvh", 0.01},
                      RealDialect{"bvh_misc/demos/data/AV_8Walk_Meredith_HVHA_Rep1.bvh", 0.0254},
                      RealDialect{"bandai_bvh/dataset-1_walk_normal_001.bvh", 0.01},
                      RealDialect{"xsens_mvnx_bvh/test_mocap.bvh", 0.01}));

}  // namespace
}  // namespace chorus::motion

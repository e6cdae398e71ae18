#include "common/motion/htr.h"

#include <gtest/gtest.h>

#include "common/motion/motion.h"
#include "tests/support/matchers.h"

namespace chorus::motion {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::VectorNear;

/// Hips and a thigh whose rest is turned by 90 degrees about z, so that its own +y is the hips' -x;
/// children come before parents, names of units and comments as programs write them.
constexpr const char* kLegs = R"([Header]
# KeyWord<space>Value<CR>
FileType htr
DataType HTRS
FileVersion 1    #integer
NumSegments 2
NumFrames 2
DataFrameRate 50
EulerRotationOrder ZYX
CalibrationUnits cm
RotationUnits Degrees
GlobalAxisofGravity Y
BoneLengthAxis Y
ScaleFactor 1.00
[SegmentNames&Hierarchy]
#CHILD PARENT
LeftUpLeg Hips
Hips GLOBAL
[BasePosition]
#SegmentName Tx, Ty, Tz, Rx, Ry, Rz, BoneLength
Hips 0 100 0 0 0 0 10
LeftUpLeg 10 0 0 0 0 90 40
[Hips]
1 0 0 0 0 0 0 1
2 5 0 0 0 0 0 1
[LeftUpLeg]
1 0 0 0 0 0 0 1
2 0 0 0 90 0 0 1
[EndOfFile]
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Eigen::Vector3d end_of_leg(const Bvh& bvh, std::size_t frame) {
  EXPECT_EQ(bvh.joints.back().name, "LeftUpLeg End");
  return joint_positions(bvh, frame).back();
}

TEST(Htr, RestThenFrameThenBone) {
  const auto htr = parse_htr(kLegs, "legs.htr");
  ASSERT_TRUE(htr) << to_string(htr.error());
  ASSERT_EQ(htr->frames.size(), 2u);
  EXPECT_DOUBLE_EQ(htr->frame_time, 0.02);
  EXPECT_EQ(htr->joints.front().name, "Hips");
  EXPECT_THAT(joint_positions(*htr, 1)[1], VectorNear(Eigen::Vector3d(0.15, 1.0, 0), 1e-9));
  EXPECT_THAT(end_of_leg(*htr, 0), VectorNear(Eigen::Vector3d(-0.3, 1.0, 0), 1e-9));
  // Turned about its own x, after the rest: +y becomes +z, which the rest leaves alone.
  EXPECT_THAT(end_of_leg(*htr, 1), VectorNear(Eigen::Vector3d(0.15, 1.0, 0.4), 1e-9));
}

TEST(Htr, OrdersRotationsAsItsHeaderSays) {
  const std::string turned = with(kLegs, "2 0 0 0 90 0 0 1", "2 0 0 0 90 90 0 1");
  // From left to right: Ry * Rx turns +y to +z and that to +x; Rx * Ry leaves +z.  Then the rest.
  EXPECT_THAT(end_of_leg(*parse_htr(turned, "a"), 1),
              VectorNear(Eigen::Vector3d(0.15, 1.4, 0), 1e-9));
  const auto other = parse_htr(with(with(turned, "ZYX", "XYZ"), " 90 40", " 90 40"), "a");
  EXPECT_THAT(end_of_leg(*other, 1), VectorNear(Eigen::Vector3d(0.15, 1.0, 0.4), 1e-9));
}

TEST(Htr, UnitsAndTheUpwardAxisAreTheFiles) {
  const auto mm = parse_htr(with(kLegs, "Units cm", "Units mm"), "a");
  EXPECT_THAT(end_of_leg(*mm, 0), VectorNear(Eigen::Vector3d(-0.03, 0.1, 0), 1e-9));
  const auto z_up = parse_htr(
      with(with(kLegs, "Gravity Y", "Gravity Z"), "Hips 0 100 0 0 0 0", "Hips 0 0 100 90 0 0"),
      "a");
  EXPECT_THAT(joint_positions(*z_up, 0)[0], VectorNear(Eigen::Vector3d(0, 1.0, 0), 1e-9));
  EXPECT_THAT(end_of_leg(*z_up, 0), VectorNear(Eigen::Vector3d(-0.3, 1.0, 0), 1e-9));
  EXPECT_FALSE(parse_htr(with(kLegs, "Units cm", "Units parsec"), "a"));
}

TEST(Htr, MarksOfMissingDataAreNobody) {
  const auto htr = parse_htr(with(kLegs, "2 5 0 0", "2 9999999.0 0 0"), "a");
  ASSERT_TRUE(htr);
  EXPECT_FALSE(htr->frames[0].empty());
  EXPECT_TRUE(htr->frames[1].empty());
  const auto shorter = parse_htr(with(kLegs, "2 5 0 0 0 0 0 1\n", ""), "a");
  ASSERT_TRUE(shorter);
  EXPECT_EQ(shorter->frames.size(), 1u);
  EXPECT_FALSE(shorter->notes.empty());
}

TEST(Htr, RefusesWhatItCannotRead) {
  EXPECT_THAT(parse_htr("HIERARCHY", "a"), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(parse_htr(with(kLegs, "FileType htr", "FileType htr2"), "a"),
              FailsWith(ErrorCode::Malformed));
  EXPECT_FALSE(parse_htr(with(kLegs, "LeftUpLeg Hips", "LeftUpLeg GLOBAL"), "a"));
  EXPECT_FALSE(parse_htr(with(kLegs, "Hips GLOBAL", "Hips LeftUpLeg"), "a"));
  EXPECT_FALSE(parse_htr(with(kLegs, "Hips GLOBAL", "Hips Hips"), "a"));
  EXPECT_FALSE(parse_htr(with(kLegs, "DataFrameRate 50", "DataFrameRate 0"), "a"));
  EXPECT_FALSE(parse_htr(with(kLegs, "ZYX", "ZZX"), "a"));
  for (std::size_t cut = 0; cut < std::string_view(kLegs).size(); cut += 7)
    (void)parse_htr(std::string_view(kLegs).substr(0, cut), "a");
}

TEST(Htr, HasTheJointsOfABody) {
  const auto htr = parse_htr(kLegs, "a");
  ASSERT_TRUE(htr);
  const auto motion = motion_from_bvh(*htr);
  ASSERT_TRUE(motion) << to_string(motion.error());
  EXPECT_THAT(motion->frames[1][JointId::HipLeft].position,
              VectorNear(Eigen::Vector3d(0.15, 1.0, 0), 1e-9));
}

}  // namespace
}  // namespace chorus::motion

// A hand's skeleton: axes, scale, files.
#include "common/hand/skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/hand/anthropometry.h"
#include "common/hand/bvh.h"
#include "common/hand/hand_json.h"
#include "common/hand/htr.h"
#include "common/motion/bvh.h"
#include "common/motion/htr.h"
#include "tests/support/hands/hand_scene.h"
#include "tests/support/matchers.h"

namespace chorus::hand {
namespace {

using testing::FailsWith;

/// What a perfect scan of a drawn hand would see.
HandShape shape_of(const testing::DrawnHand& drawn) {
  HandShape out;
  out.joints = drawn.joints;
  out.side = drawn.side;
  out.back_seen = drawn.back;
  out.outline.palm = drawn.joints[0];
  out.outline.palm_radius = 40.0 * drawn.pixels_per_mm;
  for (std::size_t f = 0; f < kFingers; ++f) {
    out.fingers[f].tip = drawn.joints[hand_joint(f, 3)];
    out.fingers[f].width = 17.0 * drawn.pixels_per_mm;
  }
  return out;
}

testing::DrawnHand drawn(std::uint64_t seed) {
  testing::HandScene scene;
  scene.seed = seed;
  scene.long_side = 400;
  return drawn_hand(scene);
}

TEST(ASkeleton, LiesInTheAxesOfItsPalmWhicheverSideIsSeen) {
  bool left = false, back = false;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto hand = drawn(seed);
    left = left || hand.side == Side::Left;
    back = back || hand.back;
    const Skeleton skeleton = skeleton_of(shape_of(hand), 1.0 / hand.pixels_per_mm);
    EXPECT_NEAR(skeleton.joints[hand_joint(2, 0)].x(), 0.0, 1e-9);
    EXPECT_GT(skeleton.joints[hand_joint(2, 0)].y(), 0.06);
    const double thumb = skeleton.joints[hand_joint(0, 3)].x();
    EXPECT_GT(hand.side == Side::Right ? thumb : -thumb, 0.03) << "seed " << seed;
  }
  EXPECT_TRUE(left && back) << "the seeds show both";
}

TEST(ASkeleton, AsHtrHasEveryJointWhereItIs) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto hand = drawn(seed);
    const Skeleton skeleton = skeleton_of(shape_of(hand), 1.0 / hand.pixels_per_mm);
    const auto htr = motion::parse_htr(htr_of(skeleton), "hand.htr");
    ASSERT_TRUE(htr) << to_string(htr.error());
    const auto places = motion::joint_positions(*htr, 0);
    const std::string side = skeleton.side == Side::Left ? "Left" : "Right";
    for (std::size_t j = 0; j < kHandJoints; ++j) {
      const bool tip = j > 0 && j % kFingerJoints == 0;
      const std::string name = side + std::string(layout::kHandTable[tip ? j - 1 : j].bone);
      const auto found = std::find_if(htr->joints.begin(), htr->joints.end(), [&](const auto& one) {
        return one.name == name + (tip ? " End" : "");
      });
      ASSERT_NE(found, htr->joints.end()) << name;
      const auto at = static_cast<std::size_t>(found - htr->joints.begin());
      EXPECT_LT((places[at] - skeleton.joints[j]).norm(), 2e-6) << name;
    }
  }
}

TEST(ASkeleton, WithoutAScaleIsRelative) {
  const Skeleton skeleton = skeleton_of(shape_of(drawn(1)), std::nullopt);
  EXPECT_TRUE(skeleton.relative);
  EXPECT_NEAR(length_of(skeleton), kUsualLength, 1e-9);
}

TEST(ASkeleton, SurvivesBvh) {
  const Skeleton skeleton = skeleton_of(shape_of(drawn(2)), 0.5);
  const auto bvh = motion::parse_bvh(bvh_of(skeleton), "hand.bvh");
  ASSERT_TRUE(bvh) << to_string(bvh.error());
  ASSERT_EQ(bvh->joints.size(), kHandJoints);
  const auto places = motion::joint_positions(*bvh, 0);
  for (std::size_t i = 0; i < kHandJoints; ++i)
    EXPECT_LT((places[i] - skeleton.joints[i]).norm(), 1e-5) << layout::kHandTable[i].landmark;
}

TEST(APosedHand, SurvivesBvh) {
  const Skeleton skeleton = skeleton_of(shape_of(drawn(2)), 0.5);
  Pose pose;
  pose.wrist = {0.1, 0.2, 0.3};
  pose.turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  pose.local[hand_joint(1, 1)] = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX());
  const auto bvh = motion::parse_bvh(bvh_of(skeleton, {&pose, 1}), "hand.bvh");
  ASSERT_TRUE(bvh) << to_string(bvh.error());
  const auto places = motion::joint_positions(*bvh, 0);
  const auto joints = joints_of(skeleton, pose);
  for (std::size_t i = 0; i < kHandJoints; ++i) EXPECT_LT((places[i] - joints[i]).norm(), 1e-5);
}

TEST(ASkeleton, SurvivesJson) {
  const HandShape shape = shape_of(drawn(3));
  const Skeleton skeleton = skeleton_of(shape, 0.5);
  const auto read = read_skeleton(scan_json(shape, skeleton, {"scan.png", "--dpi 50", 0.5, ""}));
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->side, skeleton.side);
  EXPECT_FALSE(read->relative);
  EXPECT_NEAR(read->widths[1], skeleton.widths[1], 1e-6);
  for (std::size_t i = 0; i < kHandJoints; ++i)
    EXPECT_LT((read->joints[i] - skeleton.joints[i]).norm(), 2e-6);
}

TEST(ASkeletonFile, ThatIsNoneIsRefused) {
  EXPECT_THAT(read_skeleton("{}"), FailsWith(ErrorCode::Malformed));
  EXPECT_FALSE(read_skeleton("[]"));
  EXPECT_FALSE(read_skeleton(R"({"format":"chorus-hand","side":"left","restMm":[]})"));
  EXPECT_FALSE(read_skeleton(R"({"format":"chorus-hand","side":"up"})"));
}

TEST(SeveralShots, GiveTheMedianOfEachBone) {
  const HandShape shape = shape_of(drawn(4));
  const std::array shots{skeleton_of(shape, 0.5), skeleton_of(shape, 0.6), skeleton_of(shape, 2.0)};
  const auto middle = median_of(shots);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(length_of(*middle), length_of(shots[1]), 0.02 * length_of(shots[1]));
  Skeleton other = shots[0];
  other.side = other.side == Side::Left ? Side::Right : Side::Left;
  EXPECT_FALSE(median_of(std::array{shots[0], other}));
  EXPECT_FALSE(median_of({}));
}

TEST(Proportions, OfAUsualHandAreNotRemarkedOnAndAMisplacedJointIs) {
  Joints joints;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const auto parts = parts_of(f);
    double y = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      joints[hand_joint(f, i + 1)] = {30.0 * static_cast<double>(f), y += parts[i]};
    joints[hand_joint(f, 0)] = {30.0 * static_cast<double>(f), 0.0};
  }
  EXPECT_TRUE(implausible_parts(joints).empty());
  joints[hand_joint(2, 1)].y() += 15.0;
  EXPECT_FALSE(implausible_parts(joints).empty());
}

}  // namespace
}  // namespace chorus::hand

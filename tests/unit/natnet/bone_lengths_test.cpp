// A skeleton's description gets the measured lengths of its person once there are enough frames.
#include "fusion-server/natnet/bone_lengths.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/outlet/rig_poses.h"

namespace chorus::natnet {
namespace {

using outlet::testing::t_pose;

constexpr PersonId kPerson{7};
constexpr std::size_t kLeftForearm = 8;  // ends at LHand
constexpr std::size_t kRightForearm = 12;

double length(const std::array<double, 3>& offset) {
  return std::hypot(offset[0], offset[1], offset[2]);
}

outlet::TrackerBody scaled(double by) {
  outlet::TrackerBody body = t_pose();
  for (outlet::TrackerJoint& joint : body.joints) joint.position *= by;
  return body;
}

MotiveSkeleton local(const outlet::TrackerBody& body) {
  return motive_skeleton(body, Coordinates::Local).value();
}

std::optional<BoneOffsets> after(BoneLengths& lengths, std::size_t frames, PersonId person,
                                 const MotiveSkeleton& shown) {
  std::optional<BoneOffsets> last;
  for (std::size_t i = 0; i < frames; ++i) {
    EXPECT_FALSE(last) << "not before the last";
    last = lengths.add(person, shown);
  }
  return last;
}

TEST(BoneLengths, AreThoseOfThePersonAfterFiveSeconds) {
  BoneLengths lengths;
  const MotiveSkeleton shown = local(scaled(1.1));
  EXPECT_FALSE(after(lengths, BoneLengths::kFrames - 1, kPerson, shown));
  EXPECT_TRUE(lengths.wants(kPerson));
  const auto found = lengths.add(kPerson, shown);
  ASSERT_TRUE(found);
  EXPECT_FALSE(lengths.wants(kPerson));
  for (std::size_t i = 1; i < kBoneCount; ++i) {
    EXPECT_NEAR(length((*found)[i]), shown[i].position.norm(), 1e-9) << motive_bones()[i].name;
    // The directions are those of the rest pose; only the lengths differ.
    EXPECT_NEAR((*found)[i][1] * length(motive_bones()[i].offset),
                motive_bones()[i].offset[1] * length((*found)[i]), 1e-9);
  }
  EXPECT_NEAR((*found)[0][1], 0.95 + 0.1 * 0.82, 1e-9) << "the hip stands on longer legs";
}

TEST(BoneLengths, OfAnAdultLikeTheDescriptionChangeNothing) {
  BoneLengths lengths;
  EXPECT_FALSE(after(lengths, BoneLengths::kFrames, kPerson, local(scaled(1.0))));
  EXPECT_FALSE(lengths.wants(kPerson));
}

TEST(BoneLengths, AreMediansThatFewWrongFramesDoNotMove) {
  BoneLengths lengths;
  EXPECT_FALSE(after(lengths, 60, kPerson, local(scaled(3.0))));
  const auto found = after(lengths, BoneLengths::kFrames - 60, kPerson, local(scaled(1.1)));
  ASSERT_TRUE(found);
  EXPECT_NEAR(length((*found)[kLeftForearm]), 1.1 * 0.25, 1e-9);
}

TEST(BoneLengths, OfAnArmThatIsNotSeenAreAnAdults) {
  outlet::TrackerBody body = scaled(1.1);
  for (const JointId id : {JointId::ElbowLeft, JointId::WristLeft})
    body.joints[index_of(id)].tracked = false;
  BoneLengths lengths;
  const auto found = after(lengths, BoneLengths::kFrames, kPerson, local(body));
  ASSERT_TRUE(found);
  EXPECT_NEAR(length((*found)[kLeftForearm]), 0.25, 1e-9);
  EXPECT_NEAR(length((*found)[kRightForearm]), 1.1 * 0.25, 1e-9);
}

TEST(BoneLengths, OfTheNextPersonAreMeasuredAnew) {
  BoneLengths lengths;
  EXPECT_TRUE(after(lengths, BoneLengths::kFrames, kPerson, local(scaled(1.1))));
  EXPECT_TRUE(lengths.wants({8}));
  EXPECT_FALSE(after(lengths, BoneLengths::kFrames - 1, {8}, local(scaled(0.9))));
  const auto found = lengths.add({8}, local(scaled(0.9)));
  ASSERT_TRUE(found);
  EXPECT_NEAR(length((*found)[kLeftForearm]), 0.9 * 0.25, 1e-9);
}

}  // namespace
}  // namespace chorus::natnet

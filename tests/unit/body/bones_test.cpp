#include "common/body/bones.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace chorus {
namespace {

TEST(JointNames, GoThereAndBackAndAreUnique) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    EXPECT_EQ(joint_named(name_of(id)), id);
    names.insert(name_of(id));
  }
  EXPECT_EQ(names.size(), kJointCount);
  EXPECT_EQ(joint_named("head"), std::nullopt);
  EXPECT_EQ(joint_named(""), std::nullopt);
}

TEST(JointNames, KeepTheKinectOrder) {
  EXPECT_EQ(name_of(static_cast<JointId>(0)), "SpineBase");
  EXPECT_EQ(name_of(static_cast<JointId>(3)), "Head");
  EXPECT_EQ(name_of(static_cast<JointId>(20)), "SpineShoulder");
  EXPECT_EQ(name_of(static_cast<JointId>(24)), "ThumbRight");
}

TEST(Bones, AreATreeFromSpineBaseWithParentsFirst) {
  std::set<JointId> reached{JointId::SpineBase};
  for (const auto& [parent, child] : kBones) {
    EXPECT_TRUE(reached.contains(parent)) << name_of(parent);
    EXPECT_TRUE(reached.insert(child).second) << name_of(child) << " hangs on two parents";
  }
  EXPECT_EQ(reached.size(), kJointCount);
}

TEST(MirrorPairs, AreAnInvolutionThatKeepsTheBones) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    EXPECT_EQ(mirror(mirror(id)), id);
    const bool sided = name_of(id).ends_with("Left") || name_of(id).ends_with("Right");
    EXPECT_EQ(mirror(id) != id, sided) << name_of(id);
  }
  for (const auto& [left, right] : kMirrorPairs) {
    std::string renamed(name_of(left));
    renamed.replace(renamed.find("Left"), 4, "Right");
    EXPECT_EQ(renamed, name_of(right));
  }
  for (const auto& [parent, child] : kBones) {
    const bool found = std::ranges::any_of(kBones, [&](const Bone& bone) {
      return bone.parent == mirror(parent) && bone.child == mirror(child);
    });
    EXPECT_TRUE(found) << name_of(child);
  }
}

TEST(CoreJoints, AreTheirOwnMirror) {
  for (const JointId id : kCoreJoints) EXPECT_EQ(mirror(id), id);
}

}  // namespace
}  // namespace chorus

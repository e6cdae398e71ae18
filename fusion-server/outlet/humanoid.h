// The body as a rig that rests in T-pose: what humanoid protocols (VMC, VRChat, DTrack's 6dj) send.
//
// World space, metres.  The rig at rest looks along the world's -z, its left hand at -x, +y up:
// that is Unity's T-pose, +z forward, after unity_axes().  A bone's rotation takes directions of
// the rig at rest to directions in the world, so a person in T-pose who looks along -z has
// identities only.
//
// Rotations come from where the joints are: every bone lies along its two joints, exactly; what is
// left, the twist about the bone, comes
//   of the trunk:   from the line of the hips (Hips), of the shoulders (Chest), of both (Spine),
//   of neck, head:  from the shoulders' line, turned as the joint's own orientation turns against
//                   that of SpineShoulder (the only place where orientations are used: those of
//                   limbs err by 50-170 degrees about the bone, those of leaves do not exist),
//   of the limbs:   from the plane of elbow or knee once it bends (15 to 30 degrees, faded in);
//                   of a straight limb, from the shortest turn out of T-pose relative to the trunk,
//   of the hands:   from the thumb, else as the forearm,
//   of the feet:    from the lower leg.
// UpperChest and the shoulders follow Chest, the toes follow the foot.  A flat foot's ankle-to-foot
// line falls by 25 degrees, as the sensors place these joints.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::outlet {

// clang-format off
/// Unity's HumanBodyBones, as far as we know them; parents come before children.
enum class HumanBone : std::uint8_t {
  Hips, Spine, Chest, UpperChest, Neck, Head,
  LeftShoulder, LeftUpperArm, LeftLowerArm, LeftHand,
  RightShoulder, RightUpperArm, RightLowerArm, RightHand,
  LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes,
  RightUpperLeg, RightLowerLeg, RightFoot, RightToes,
};
inline constexpr std::size_t kHumanBoneCount = 22;
inline constexpr std::array<std::string_view, kHumanBoneCount> kHumanBoneNames{
    "Hips", "Spine", "Chest", "UpperChest", "Neck", "Head",
    "LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand",
    "RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand",
    "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes",
    "RightUpperLeg", "RightLowerLeg", "RightFoot", "RightToes"};
// clang-format on

struct BonePose {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< The joint it turns about.
  Eigen::Quaterniond world_from_bone = Eigen::Quaterniond::Identity();
  /// False: its joints are not tracked; then it has its parent's place and rotation, so that its
  /// children's frames are right even for those who ignore this flag.
  bool known = false;
};

struct Humanoid {
  std::array<BonePose, kHumanBoneCount> bones;

  [[nodiscard]] const BonePose& operator[](HumanBone bone) const {
    return bones[static_cast<std::size_t>(bone)];
  }
  [[nodiscard]] BonePose& operator[](HumanBone bone) {
    return bones[static_cast<std::size_t>(bone)];
  }
};

/// A pose in the world, in the frame of another pose.
[[nodiscard]] BonePose relative_to(const BonePose& parent, const BonePose& pose);

/// Hips is its own parent.
[[nodiscard]] HumanBone parent_of(HumanBone bone);

/// Total: Hips is unknown when the pelvis is not tracked or nothing says where the body faces; then
/// no bone of the body is known.  Every origin and rotation is finite.
[[nodiscard]] Humanoid humanoid_of(const TrackerBody& body);

}  // namespace chorus::outlet

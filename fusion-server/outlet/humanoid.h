// The body as a rig that rests in T-pose, which humanoid protocols (VMC, VRChat, DTrack's 6dj)
// send.
//
// World space, metres.  At rest the rig looks along the world's -z, with its left hand at -x and +y
// up; after unity_axes() this is Unity's T-pose, which looks along +z.  A bone's rotation takes
// directions of the rig at rest to directions in the world, so for a person in T-pose who looks
// along -z all rotations are the identity.
//
// Rotations follow from the positions of the joints.  Hips lies exactly along the line of the hips,
// tilted as the spine is.  Every other bone lies exactly along its two joints; what remains, the
// twist about the bone, is taken
//   for the trunk:   from the line of the shoulders (Chest), of hips and shoulders (Spine),
//   for neck, head:  from the shoulders' line, rotated as the joint's own orientation is against
//                    that of SpineShoulder, or from the head's own orientation where only the head
//                    has one (the only use of orientations: those of limbs are wrong
//                    by 50-170 degrees about the bone, and leaf joints have none),
//   for the limbs:   from a sensor that is worn on them; otherwise from the plane of elbow or knee
//   if bent (faded in from 15 to 30 degrees); for
//                    a straight limb, by the shortest turn out of T-pose relative to the trunk,
//   for the hands:   from the thumb, otherwise like the forearm,
//   for the feet:    from the lower leg.
// UpperChest and the shoulders follow Chest, the toes follow the foot.  The ankle-to-foot line of a
// flat foot points down by 25 degrees, because of where sensors place these joints.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::outlet {

// clang-format off
/// Those of Unity's HumanBodyBones that our joints determine; parents come before children.
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
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< The joint about which the bone turns.
  Eigen::Quaterniond world_from_bone = Eigen::Quaterniond::Identity();
  /// False: not all joints that the bone needs are tracked. Then it has its parent's position and
  /// rotation, so that the poses of its children are right even for receivers that ignore this
  /// flag.
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

/// `pose` relative to `parent`; both are given in the world.
[[nodiscard]] BonePose relative_to(const BonePose& parent, const BonePose& pose);

/// The parent of Hips is Hips.
[[nodiscard]] HumanBone parent_of(HumanBone bone);

/// The pose of the rig.  Every origin and rotation is finite.  Hips is unknown when the pelvis is
/// not tracked or the body's facing is unknown; then every bone is.
[[nodiscard]] Humanoid humanoid_of(const TrackerBody& body);

}  // namespace chorus::outlet

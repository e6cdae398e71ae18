#include "fusion-server/natnet/motive_skeleton.h"

#include "fusion-server/outlet/axes.h"
#include "fusion-server/outlet/humanoid.h"

namespace chorus::natnet {
namespace {

using enum outlet::HumanBone;

// Parents come before children.  Offsets are to the left, up and forward; limbs and trunk are those
// of the simulated adult; the feet point down by 25 degrees, as in the rig.
constexpr std::array<BoneDescription, kBoneCount> kTable{{
    {"Hip", 0, {0, 0.95, 0}},           {"Ab", 1, {0, 0.083, 0}},
    {"Chest", 2, {0, 0.167, 0}},        {"Neck", 3, {0, 0.23, 0}},
    {"Head", 4, {0, 0.07, 0}},          {"LShoulder", 3, {0.054, 0.227, 0}},
    {"LUArm", 6, {0.126, -0.007, 0}},   {"LFArm", 7, {0.28, 0, 0}},
    {"LHand", 8, {0.25, 0, 0}},         {"RShoulder", 3, {-0.054, 0.227, 0}},
    {"RUArm", 10, {-0.126, -0.007, 0}}, {"RFArm", 11, {-0.28, 0, 0}},
    {"RHand", 12, {-0.25, 0, 0}},       {"LThigh", 1, {0.09, -0.04, 0}},
    {"LShin", 14, {0, -0.41, 0}},       {"LFoot", 15, {0, -0.41, 0}},
    {"RThigh", 1, {-0.09, -0.04, 0}},   {"RShin", 17, {0, -0.41, 0}},
    {"RFoot", 18, {0, -0.41, 0}},       {"LToe", 16, {0, -0.059, 0.127}},
    {"RToe", 19, {0, -0.059, 0.127}},
}};

constexpr std::array<outlet::HumanBone, kBoneCount> kRigBones{
    Hips,         Spine,    Chest,         Neck,          Head,          LeftShoulder, LeftUpperArm,
    LeftLowerArm, LeftHand, RightShoulder, RightUpperArm, RightLowerArm, RightHand,    LeftUpperLeg,
    LeftLowerLeg, LeftFoot, RightUpperLeg, RightLowerLeg, RightFoot,     LeftToes,     RightToes};

std::size_t parent_index(std::size_t bone) {
  return static_cast<std::size_t>(kTable[bone].parent - 1);
}

/// The bone in world space; `done` contains the bones before it in the table.
MotiveBone in_world(const outlet::Humanoid& rig, std::size_t bone, const MotiveSkeleton& done) {
  const outlet::BonePose& pose = rig[kRigBones[bone]];
  if (pose.known) return {pose.origin, pose.world_from_bone * outlet::rig_from_ahead_rest(), true};
  if (kTable[bone].parent == 0) return {};
  const MotiveBone& parent = done[parent_index(bone)];
  const auto& [x, y, z] = kTable[bone].offset;
  return {parent.position + parent.orientation * Eigen::Vector3d(x, y, z), parent.orientation,
          false};
}

outlet::BonePose pose_of(const MotiveBone& bone) { return {bone.position, bone.orientation, true}; }

MotiveSkeleton local(const MotiveSkeleton& world) {
  MotiveSkeleton out = world;
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    if (kTable[i].parent == 0) continue;
    const outlet::BonePose in_parent =
        outlet::relative_to(pose_of(world[parent_index(i)]), pose_of(world[i]));
    out[i].position = in_parent.origin;
    out[i].orientation = in_parent.world_from_bone;
  }
  return out;
}

}  // namespace

const std::array<BoneDescription, kBoneCount>& motive_bones() { return kTable; }

std::optional<MotiveSkeleton> motive_skeleton(const outlet::TrackerBody& body,
                                              Coordinates coordinates) {
  const outlet::Humanoid rig = outlet::humanoid_of(body);
  if (!rig[Hips].known) return std::nullopt;
  MotiveSkeleton world;
  for (std::size_t i = 0; i < kBoneCount; ++i) world[i] = in_world(rig, i, world);
  return coordinates == Coordinates::Local ? local(world) : world;
}

}  // namespace chorus::natnet

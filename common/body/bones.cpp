#include "common/body/bones.h"

namespace chorus {

std::optional<JointId> joint_named(std::string_view name) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (kJointNames[i] == name) return static_cast<JointId>(i);
  }
  return std::nullopt;
}

JointId parent_of(JointId id) {
  for (const Bone& bone : kBones) {
    if (bone.child == id) return bone.parent;
  }
  return id;
}

JointId mirror(JointId id) {
  for (const auto& [left, right] : kMirrorPairs) {
    if (id == left) return right;
    if (id == right) return left;
  }
  return id;
}

}  // namespace chorus

// The body as the 21 bones that OptiTrack's Motive streams, for clients that know these names.
//
// Names, order and hierarchy are Motive's ("Hip", "Ab", "Chest", ...).  The rest pose is the T-pose
// that looks along +z with the left hand at +x, in which every bone has the identity rotation.  The
// rig and the twists are those of humanoid.h, whose UpperChest turns like Chest and has no bone
// here.  World space, metres.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::natnet {

inline constexpr std::size_t kBoneCount = 21;

/// A bone of the description; its id is its index in the table plus one.
struct BoneDescription {
  std::string_view name;
  std::int32_t parent = 0;  ///< Id; 0: none.
  /// Offset from the parent's origin at rest, for an adult of 1.75 m [m]: clients build their rest
  /// pose from it.  Frames contain the person's own lengths.
  std::array<double, 3> offset{};
};

[[nodiscard]] const std::array<BoneDescription, kBoneCount>& motive_bones();

struct MotiveBone {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// False if the bone's joints are not tracked; then it has its rest position relative to its
  /// parent.
  bool tracked = false;
};
using MotiveSkeleton = std::array<MotiveBone, kBoneCount>;

enum class Coordinates {
  Local,   ///< Each bone is relative to its parent; the hip is in world space.
  Global,  ///< All bones are in world space.
};

/// The bones; none when the pelvis is not tracked, or when it is unknown which way the body faces.
[[nodiscard]] std::optional<MotiveSkeleton> motive_skeleton(const outlet::TrackerBody& body,
                                                            Coordinates coordinates);

}  // namespace chorus::natnet

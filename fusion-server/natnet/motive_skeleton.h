// The body as the 21 bones that OptiTrack's Motive streams, for clients that look for them by name.
//
// Names, order and hierarchy are Motive's ("Hip", "Ab", "Chest", ...); its rest pose is the T-pose
// that looks along +z with the left hand at +x; every bone at rest has the identity.  The rig and
// the twists are those of humanoid.h, where UpperChest turns as Chest does and has no bone here.
// World space, metres.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::natnet {

inline constexpr std::size_t kBoneCount = 21;

/// A bone of the description; its id is its place in the table plus one.
struct BoneDescription {
  std::string_view name;
  std::int32_t parent = 0;  ///< Id; 0: none.
  /// From the parent's origin at rest, for an adult 1.75 m tall: clients build their own rest pose
  /// from it.  Frames carry the person's own lengths [m].
  std::array<double, 3> offset{};
};

[[nodiscard]] const std::array<BoneDescription, kBoneCount>& motive_bones();

struct MotiveBone {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// False: its joints are not tracked; then it has the place at its parent that it has at rest.
  bool tracked = false;
};
using MotiveSkeleton = std::array<MotiveBone, kBoneCount>;

enum class Coordinates {
  Local,   ///< Each bone in the frame of its parent, the hip in the world.
  Global,  ///< All in the world.
};

/// Empty when the pelvis is not tracked, or when it is unknown which way the body faces.
[[nodiscard]] std::optional<MotiveSkeleton> motive_skeleton(const outlet::TrackerBody& body,
                                                            Coordinates coordinates);

}  // namespace chorus::natnet

// Acclaim ASF (skeleton) and AMC (motion), as the CMU motion capture library uses them.
//
// A bone starts at its parent's end; where the file names a bone as a point, it means that bone's
// end. With C the rotation of the bone's `axis` and R that of its channels (both about fixed axes,
// x first: Rz Ry Rx),
//   world_from_bone = world_from_parent * C * R * C^-1,
//   end = parent end + length * world_from_bone * direction
// (Lander, "Working with motion capture file formats"; checked against another implementation and
// by tests: feet on the floor, left on the left).  In CMU files, lengths are inches times the unit
// `length` of the header.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::motion {

struct AsfBone {
  std::string name;
  /// Index into AsfSkeleton::bones, less than the bone's own; 0 is the root.
  std::size_t parent = 0;
  Eigen::Vector3d reach = Eigen::Vector3d::Zero();           ///< length * direction [m]
  Eigen::Quaterniond axis = Eigen::Quaterniond::Identity();  ///< The rotation C.
  std::array<bool, 3> turns{};    ///< Which of rx, ry, rz have a channel, in this order.
  std::size_t first_channel = 0;  ///< Index of the bone's first channel in AmcFrame.
};

struct AsfSkeleton {
  std::vector<AsfBone> bones;  ///< bones[0] is the root: reach zero, channels tx ty tz rx ry rz.
  std::size_t channel_count = 0;
  double metres_per_unit = 0.0;
};

/// All channels of one frame, in the order of the bones: root tx ty tz [m], then all angles [rad].
using AmcFrame = std::vector<double>;

[[nodiscard]] Result<AsfSkeleton> parse_asf(std::string_view text, std::string_view origin);

/// Refuses unknown bones, wrong counts, missing bones and frames that are out of order.
[[nodiscard]] Result<std::vector<AmcFrame>> parse_amc(std::string_view text,
                                                      std::string_view origin,
                                                      const AsfSkeleton& skeleton);

/// The end points of all bones, in their order, in the file's world space (y up) [m].
[[nodiscard]] std::vector<Eigen::Vector3d> bone_ends(const AsfSkeleton& skeleton,
                                                     const AmcFrame& frame);

/// The index of the bone with this name; bones.size() when there is none.
[[nodiscard]] std::size_t bone_named(const AsfSkeleton& skeleton, std::string_view name);

}  // namespace chorus::motion

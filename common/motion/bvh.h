// Biovision BVH: a hierarchy of joints with offsets and channels, then one line of numbers per
// frame.
//
// parent_from_joint = translate(offset or position channels) * R(first channel) * R(second) *
// R(third), in the order in which the file lists the channels.  Lengths are in the file's unit
// (usually centimetres); `metres_per_unit` converts them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::motion {

struct BvhJoint {
  std::string name;        ///< An end site is called "<parent> End".
  std::size_t parent = 0;  ///< Index, less than the joint's own; 0 is the root.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< From the parent [m]
  std::vector<std::uint8_t> channels;                ///< 0-2: x y z position, 3-5: x y z rotation.
  std::size_t first_channel = 0;
};

struct Bvh {
  std::vector<BvhJoint> joints;
  std::size_t channel_count = 0;
  double frame_time = 0.0;  ///< [s]
  /// Positions [m], rotations [rad], in the order of the channels; empty where a line between
  /// others could not be read.
  std::vector<std::vector<double>> frames;
  std::vector<std::string> notes = {};  ///< What was salvaged.
};

/// The lines that are there count, not the announced number of frames; a cut last line is left out;
/// both with a note.  Names may contain blanks ("Bip01 L Thigh"), keywords and channels be written
/// in any case, decimals have a comma.
[[nodiscard]] Result<Bvh> parse_bvh(std::string_view text, std::string_view origin,
                                    double metres_per_unit = 0.01);

/// Position of every joint in one frame, in the file's world space [m].
[[nodiscard]] std::vector<Eigen::Vector3d> joint_positions(const Bvh& bvh, std::size_t frame);

}  // namespace chorus::motion

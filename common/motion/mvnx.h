// MVNX: the XML of Xsens MVN Studio, versions 3 and 4 (Xsens MVN User Manual, "MVNX").
//
// One subject with named segments and points on them, then frames: position and orientation of
// every segment in a right-handed space with +x ahead, +y left, +z up; metres; quaternions w x y z.
// In the T-pose the axes of all segments are those of that space.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/motion/motion.h"

namespace chorus::motion {

struct MvnxPoint {
  std::string label;                                     ///< "jLeftHip", "pTopOfHead"
  Eigen::Vector3d in_segment = Eigen::Vector3d::Zero();  ///< [m]
};

struct MvnxSegment {
  std::string label;  ///< "Pelvis", "LeftUpperArm"
  std::vector<MvnxPoint> points;
};

struct MvnxFrame {
  double time = 0.0;                       ///< Since the first frame [s], by its index and "time".
  std::vector<Eigen::Vector3d> positions;  ///< Origins of the segments [m].
  std::vector<Eigen::Quaterniond> orientations;  ///< world_from_segment, in the file's world.
  std::vector<Eigen::Quaterniond> sensor_orientations;  ///< One per sensor, if the file has them.
};

struct Mvnx {
  std::string subject;
  double rate_hz = 0.0;
  std::vector<MvnxSegment> segments;
  std::vector<std::string> sensors;
  bool fingers = false;           ///< The file also has finger tracking, which is not read.
  std::vector<MvnxFrame> frames;  ///< Calibration poses (types other than "normal") are left out.
};

/// A larger file is refused.
inline constexpr std::size_t kMaxMvnxBytes = 512u << 20;

/// Parses a file.  Refuses entity declarations, elements nested deeper than 32, frames whose
/// numbers do not match the segments, and text where a number should be.  Elements count by their
/// path, so those of finger tracking and unknown ones are skipped.
[[nodiscard]] Result<Mvnx> parse_mvnx(std::string_view xml, std::string_view origin);

/// Computes joints from points on segments (the table is in mvnx_joints.cpp); the segments'
/// rotations, twist included, become joint orientations.  A joint whose segment or point is missing
/// is not tracked; a file without Pelvis is refused.
[[nodiscard]] Result<Motion> motion_from_mvnx(const Mvnx& mvnx);

}  // namespace chorus::motion

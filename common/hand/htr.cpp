#include "common/hand/htr.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "common/base/units.h"

namespace chorus::hand {
namespace {

bool is_tip(std::size_t joint) {
  return joint > 0 && (joint - 1) % kFingerJoints == kFingerJoints - 1;
}

/// The joint to which the segment of this one reaches.
std::size_t reached(std::size_t joint) { return joint == 0 ? hand_joint(2, 0) : joint + 1; }

/// +y along the segment, +z as near to the palm's as can be.
Eigen::Quaterniond along_segment(const Skeleton& skeleton, std::size_t joint) {
  const Eigen::Vector3d reach = skeleton.joints[reached(joint)] - skeleton.joints[joint];
  if (!(reach.norm() > 0.0)) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d y = reach.normalized();
  const Eigen::Vector3d x = y.cross(Eigen::Vector3d::UnitZ());
  if (x.norm() < 1e-9) return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), y);
  Eigen::Matrix3d axes;
  axes << x.normalized(), y, x.normalized().cross(y);
  return Eigen::Quaterniond(axes);
}

/// Translation [mm] and rotation [deg] in the parent, and the length [mm].
std::string rest_of(const Skeleton& skeleton, std::size_t joint) {
  const std::size_t parent = layout::kHandTable[joint].parent;
  const Eigen::Quaterniond before =
      joint == 0 ? Eigen::Quaterniond::Identity() : along_segment(skeleton, parent);
  const Eigen::Vector3d from =
      joint == 0 ? skeleton.joints[0]
                 : Eigen::Vector3d(skeleton.joints[joint] - skeleton.joints[parent]);
  const Eigen::Vector3d t = before.inverse() * from;
  const Eigen::Matrix3d r =
      (before.inverse() * along_segment(skeleton, joint)).normalized().toRotationMatrix();
  const double length = (skeleton.joints[reached(joint)] - skeleton.joints[joint]).norm();
  return fmt::format("{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}", to_mm(t.x()),
                     to_mm(t.y()), to_mm(t.z()), to_deg(std::atan2(r(2, 1), r(2, 2))),
                     to_deg(std::asin(std::clamp(-r(2, 0), -1.0, 1.0))),
                     to_deg(std::atan2(r(1, 0), r(0, 0))), to_mm(length));
}

}  // namespace

std::string htr_of(const Skeleton& skeleton) {
  std::vector<std::size_t> segments;
  for (std::size_t i = 0; i < kHandJoints; ++i)
    if (!is_tip(i)) segments.push_back(i);
  const auto name = [&](std::size_t joint) {
    return fmt::format("{}{}", skeleton.side == Side::Left ? "Left" : "Right",
                       layout::kHandTable[joint].bone);
  };
  std::string out = fmt::format(
      "[Header]\nFileType htr\nDataType HTRS\nFileVersion 1\nNumSegments {}\nNumFrames 1\n"
      "DataFrameRate 60\nEulerRotationOrder ZYX\nCalibrationUnits mm\nRotationUnits Degrees\n"
      "GlobalAxisofGravity Y\nBoneLengthAxis Y\nScaleFactor 1.00\n[SegmentNames&Hierarchy]\n"
      "#CHILD\tPARENT\n",
      segments.size());
  for (const std::size_t i : segments)
    out += name(i) + '\t' + (i == 0 ? "GLOBAL" : name(layout::kHandTable[i].parent)) + '\n';
  out += "[BasePosition]\n#SegmentName Tx, Ty, Tz, Rx, Ry, Rz, BoneLength\n";
  for (const std::size_t i : segments) out += name(i) + '\t' + rest_of(skeleton, i) + '\n';
  for (const std::size_t i : segments)
    out += fmt::format("[{}]\n#Fr\tTx\tTy\tTz\tRx\tRy\tRz\tSF\n1\t0\t0\t0\t0\t0\t0\t1\n", name(i));
  return out + "[EndOfFile]\n";
}

}  // namespace chorus::hand

#include "common/hand/bvh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::hand {
namespace {

constexpr double kCentimetres = 100.0;  // per metre

/// z, x, y in degrees with q = Rz * Rx * Ry.
Eigen::Vector3d angles_of(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d m = q.normalized().toRotationMatrix();
  const double x = std::asin(std::clamp(m(2, 1), -1.0, 1.0));
  return {to_deg(std::atan2(-m(0, 1), m(1, 1))), to_deg(x), to_deg(std::atan2(-m(2, 0), m(2, 2)))};
}

struct Writer {
  const Skeleton& skeleton;
  std::string text;
  std::vector<std::size_t> order;

  void offset(std::size_t joint, const std::string& indent) {
    const std::size_t parent = layout::kHandTable[joint].parent;
    const Eigen::Vector3d v = kCentimetres * (skeleton.joints[joint] - skeleton.joints[parent]);
    text += fmt::format("{}OFFSET {:.4f} {:.4f} {:.4f}\n", indent, v.x(), v.y(), v.z());
  }

  void joint(std::size_t i, int depth) {
    const std::string indent(static_cast<std::size_t>(depth), '\t'), inner = indent + '\t';
    const bool tip = i > 0 && (i - 1) % kFingerJoints == kFingerJoints - 1;
    const char* const side = skeleton.side == Side::Left ? "Left" : "Right";
    text += tip ? fmt::format("{}End Site\n{}{{\n", indent, indent)
                : fmt::format("{}{} {}{}\n{}{{\n", indent, i == 0 ? "ROOT" : "JOINT", side,
                              layout::kHandTable[i].bone, indent);
    offset(i, inner);
    if (!tip) {
      text += inner + (i == 0 ? "CHANNELS 6 Xposition Yposition Zposition " : "CHANNELS 3 ") +
              "Zrotation Xrotation Yrotation\n";
      order.push_back(i);
    }
    for (std::size_t child = i + 1; child < kHandJoints; ++child) {
      if (layout::kHandTable[child].parent == i) joint(child, depth + 1);
    }
    text += indent + "}\n";
  }

  void frame(const Pose& pose) {
    const Eigen::Vector3d at = kCentimetres * pose.wrist;
    text += fmt::format("{:.4f} {:.4f} {:.4f}", at.x(), at.y(), at.z());
    for (const std::size_t i : order) {
      const Eigen::Vector3d a = angles_of(i == 0 ? pose.turn : pose.local[i]);
      text += fmt::format(" {:.4f} {:.4f} {:.4f}", a[0], a[1], a[2]);
    }
    text += "\n";
  }
};

}  // namespace

std::array<Eigen::Quaterniond, kHandJoints> Pose::rest() {
  std::array<Eigen::Quaterniond, kHandJoints> out;
  out.fill(Eigen::Quaterniond::Identity());
  return out;
}

std::array<Eigen::Vector3d, kHandJoints> joints_of(const Skeleton& skeleton, const Pose& pose) {
  std::array<Eigen::Vector3d, kHandJoints> out;
  std::array<Eigen::Quaterniond, kHandJoints> turn;
  out[0] = pose.wrist;
  turn[0] = pose.turn;
  for (std::size_t i = 1; i < kHandJoints; ++i) {
    const std::size_t parent = layout::kHandTable[i].parent;
    out[i] = out[parent] + turn[parent] * (skeleton.joints[i] - skeleton.joints[parent]);
    turn[i] = turn[parent] * pose.local[i];
  }
  return out;
}

std::string bvh_of(const Skeleton& skeleton, std::span<const Pose> poses, double rate_hz) {
  const Pose rest;
  if (poses.empty()) poses = {&rest, 1};
  Writer writer{skeleton, "HIERARCHY\n", {}};
  writer.joint(0, 0);
  writer.text +=
      fmt::format("MOTION\nFrames: {}\nFrame Time: {:.7f}\n", poses.size(), 1.0 / rate_hz);
  for (const Pose& pose : poses) writer.frame(pose);
  return std::move(writer.text);
}

}  // namespace chorus::hand

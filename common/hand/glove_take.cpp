#include "common/hand/glove_take.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "common/motion/bvh.h"

namespace chorus::hand {
namespace {

constexpr std::string_view kMixamo = "mixamorig:";

/// Indices of the hand's joints in the file.
using Found = std::array<std::optional<std::size_t>, kHandJoints>;

Found find_joints(const motion::Bvh& bvh, Side side) {
  const std::string prefix = side == Side::Left ? "Left" : "Right";
  Found out;
  for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
    std::string_view name = bvh.joints[i].name;
    if (name.starts_with(kMixamo)) name.remove_prefix(kMixamo.size());
    for (std::size_t j = 0; j < kHandJoints; ++j) {
      if (name == prefix + std::string(layout::kHandTable[j].bone)) out[j] = i;
    }
  }
  return out;
}

/// parent_from_joint, without its place.
Eigen::Quaterniond local_turn(const motion::BvhJoint& joint, const std::vector<double>& frame) {
  Eigen::Quaterniond out = Eigen::Quaterniond::Identity();
  for (std::size_t c = 0; c < joint.channels.size(); ++c) {
    if (joint.channels[c] < 3) continue;
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(joint.channels[c] - 3);
    out = out * Eigen::AngleAxisd(frame[joint.first_channel + c], axis);
  }
  return out;
}

Pose pose_of(const motion::Bvh& bvh, const Found& joints, std::size_t frame) {
  Pose out;
  const std::vector<double>& values = bvh.frames[frame];
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  for (std::size_t i = *joints[0];; i = bvh.joints[i].parent) {
    turn = local_turn(bvh.joints[i], values) * turn;
    if (i == bvh.joints[i].parent) break;
  }
  out.turn = turn.normalized();
  out.wrist = motion::joint_positions(bvh, frame)[*joints[0]];
  for (std::size_t j = 1; j < kHandJoints; ++j) {
    if (joints[j]) out.local[j] = local_turn(bvh.joints[*joints[j]], values).normalized();
  }
  return out;
}

Pose mixed(const Pose& a, const Pose& b, double share) {
  Pose out;
  out.wrist = (1.0 - share) * a.wrist + share * b.wrist;
  out.turn = a.turn.slerp(share, b.turn);
  for (std::size_t j = 0; j < kHandJoints; ++j) out.local[j] = a.local[j].slerp(share, b.local[j]);
  return out;
}

}  // namespace

Result<GloveTake> read_glove_take(std::string_view text, std::string_view origin, Side side) {
  const auto bvh = motion::parse_bvh(text, origin);
  if (!bvh) return pass(bvh);
  const Found joints = find_joints(*bvh, side);
  if (!joints[0])
    return fail(ErrorCode::NotFound, std::string(origin),
                std::string("has no joint ") + (side == Side::Left ? "LeftHand" : "RightHand") +
                    ", as chorus scan names it");
  GloveTake out;
  out.side = side;
  out.alone = bvh->joints[*joints[0]].parent == *joints[0];
  if (bvh->frame_time > 0.0) out.rate_hz = 1.0 / bvh->frame_time;
  for (std::size_t i = 0; i < bvh->frames.size(); ++i) {
    if (!bvh->frames[i].empty()) {
      out.poses.push_back(pose_of(*bvh, joints, i));
    } else if (!out.poses.empty()) {
      out.poses.push_back(out.poses.back());  // An unreadable line: as before.
    }
  }
  if (out.poses.empty()) return fail(ErrorCode::Malformed, std::string(origin), "has no frame");
  return out;
}

Pose pose_at(const GloveTake& take, double seconds) {
  const double last = static_cast<double>(take.poses.size() - 1);
  const double at = std::isfinite(seconds) ? std::clamp(seconds * take.rate_hz, 0.0, last) : 0.0;
  const auto before = static_cast<std::size_t>(at);
  const std::size_t after = std::min(before + 1, take.poses.size() - 1);
  return mixed(take.poses[before], take.poses[after], at - static_cast<double>(before));
}

}  // namespace chorus::hand

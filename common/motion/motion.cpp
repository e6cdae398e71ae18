#include "common/motion/motion.h"

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"
#include "common/body/interpolate.h"
#include "common/geometry/rotation.h"

namespace chorus::motion {
namespace {

constexpr double kTiny = 1e-6;
constexpr double kFastest = 30.0;  // No joint is faster, not even a thrower's hand [m/s].

/// The joints whose orientation a Kinect v2 does not give.
constexpr std::array kLeaves{JointId::Head,         JointId::HandTipLeft, JointId::ThumbLeft,
                             JointId::HandTipRight, JointId::ThumbRight,  JointId::FootLeft,
                             JointId::FootRight};

Eigen::Vector3d forward_of(const Skeleton<WorldSpace>& body) {
  const Eigen::Vector3d to_left =
      body[JointId::HipLeft].position - body[JointId::HipRight].position;
  return to_left.cross(Eigen::Vector3d::UnitY()).stableNormalized();
}

Eigen::Quaterniond segment_frame(const Eigen::Vector3d& along, const Eigen::Vector3d& forward) {
  const Eigen::Vector3d y = along.stableNormalized();
  Eigen::Vector3d x = y.cross(forward);
  // For a bone that points forward, this x is undefined; the other x makes the segment's +z point
  // up.
  if (x.norm() < 0.1) x = y.cross(Eigen::Vector3d::UnitY());
  if (x.norm() < kTiny || y.norm() < kTiny) return Eigen::Quaterniond::Identity();
  Eigen::Matrix3d world_from_segment;
  world_from_segment.col(0) = x.normalized();
  world_from_segment.col(1) = y;
  world_from_segment.col(2) = x.normalized().cross(y);
  return Eigen::Quaterniond(world_from_segment);
}

}  // namespace

void orient_segments(Skeleton<WorldSpace>& body) {
  const Eigen::Vector3d forward = forward_of(body);
  for (const Bone& bone : kBones) {
    Joint& child = body[bone.child];
    if (!child.seen() || !body[bone.parent].seen()) continue;
    child.orientation = segment_frame(child.position - body[bone.parent].position, forward);
  }
  if (body[JointId::SpineBase].seen() && body[JointId::SpineMid].seen()) {
    body[JointId::SpineBase].orientation = segment_frame(
        body[JointId::SpineMid].position - body[JointId::SpineBase].position, forward);
  }
  for (const JointId leaf : kLeaves) body[leaf].orientation = Eigen::Quaterniond(0, 0, 0, 0);
}

bool starts_with_pose(const Motion& motion) {
  if (motion.frames.size() < 3) return false;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& first = motion.frames[0].joints[i];
    const Joint& second = motion.frames[1].joints[i];
    const double way = (second.position - first.position).norm();
    if (first.seen() && second.seen() && way * motion.rate_hz > kFastest) return true;
  }
  return false;
}

Skeleton<WorldSpace> at(const Motion& motion, double time) {
  if (motion.frames.empty()) return {};
  const double last = static_cast<double>(motion.frames.size() - 1);
  const double place = std::isfinite(time) ? std::clamp(time * motion.rate_hz, 0.0, last) : 0.0;
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, motion.frames.size() - 1);
  return interpolate(motion.frames[before], motion.frames[after],
                     place - static_cast<double>(before));
}

}  // namespace chorus::motion

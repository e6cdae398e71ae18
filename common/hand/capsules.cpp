#include "common/hand/capsules.h"

#include "common/hand/anthropometry.h"

namespace chorus::hand {
namespace {

constexpr double kUsualWidth = 0.017;     // of a finger whose width is not known [m]
constexpr double kPalmHalfThick = 0.013;  // [m]
// A finger narrows from its knuckle to its end, relative to its width half-way.
constexpr std::array<double, 4> kTaper{0.56, 0.52, 0.47, 0.38};
// The distal capsule ends where the ball's rim is the finger's tip.
constexpr std::size_t kTip = 3;

}  // namespace

Capsules capsules_of(const Skeleton& skeleton, const Pose& pose) {
  const auto joints = joints_of(skeleton, pose);
  Capsules out;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const double width = skeleton.widths[f] > 0.0 ? skeleton.widths[f] : kUsualWidth;
    std::array<Ball, 4> chain;
    for (std::size_t i = 0; i < kFingerJoints; ++i)
      chain[i] = {joints[hand_joint(f, i)], kTaper[i] * width};
    const Eigen::Vector3d last = chain[kTip].centre - chain[kTip - 1].centre;
    if (last.norm() > chain[kTip].radius)
      chain[kTip].centre -= chain[kTip].radius * last.normalized();
    for (std::size_t i = 1; i < kFingerJoints; ++i) out.fingers.push_back({chain[i - 1], chain[i]});
  }
  const auto placed = [&](const Eigen::Vector3d& rest) {
    return Eigen::Vector3d(pose.wrist + pose.turn * rest);
  };
  const double half = skeleton.palm_radius - kPalmHalfThick;
  for (const double side : {-1.0, 1.0}) {
    out.palm.push_back({placed({side * 0.55 * half, 0.0, 0.0}), kPalmHalfThick});
    out.palm.push_back(
        {placed(skeleton.palm + Eigen::Vector3d(side * half, 0.0, 0.0)), kPalmHalfThick});
  }
  for (std::size_t f = 1; f < kFingers; ++f)
    out.palm.push_back({joints[hand_joint(f, 0)], 0.8 * kPalmHalfThick});
  return out;
}

}  // namespace chorus::hand

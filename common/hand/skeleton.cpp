#include "common/hand/skeleton.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/median.h"

namespace chorus::hand {
namespace {

/// Turns pixels into the rest pose's axes, still in pixels.
struct Axes {
  Pixel origin;
  Pixel up;
  double mirror = 1.0;  ///< -1 where the back is seen.

  [[nodiscard]] Eigen::Vector3d operator()(const Pixel& p) const {
    const Pixel right(-up.y(), up.x());  // with y down: up (0, -1) gives right (1, 0)
    const Pixel d = p - origin;
    return {mirror * d.dot(right), d.dot(up), 0.0};
  }
};

}  // namespace

Skeleton skeleton_of(const HandShape& hand, std::optional<double> mm_per_pixel) {
  Skeleton out;
  out.side = hand.side;
  const Pixel along = hand.joints[hand_joint(2, 0)] - hand.joints[0];
  const Axes axes{hand.joints[0], along.norm() > 0.0 ? Pixel(along.normalized()) : Pixel(0.0, -1.0),
                  hand.back_seen ? -1.0 : 1.0};
  for (std::size_t i = 0; i < kHandJoints; ++i) out.joints[i] = axes(hand.joints[i]);
  out.palm = axes(hand.outline.palm);
  out.palm_radius = hand.outline.palm_radius;
  for (std::size_t f = 0; f < kFingers; ++f)
    out.widths[f] = hand.fingers[f].touching ? 0.0 : hand.fingers[f].width;
  const double length = length_of(out);
  out.relative = !mm_per_pixel;
  const double scale =
      mm_per_pixel ? *mm_per_pixel / 1000.0 : (length > 0.0 ? kUsualLength / length : 0.0);
  for (auto& joint : out.joints) joint *= scale;
  for (double& width : out.widths) width *= scale;
  out.palm *= scale;
  out.palm_radius *= scale;
  return out;
}

double length_of(const Skeleton& skeleton) {
  double sum = (skeleton.joints[hand_joint(2, 0)] - skeleton.joints[0]).norm();
  for (std::size_t i = 1; i < kFingerJoints; ++i) sum += part_length(skeleton, 2, i);
  return sum;
}

double part_length(const Skeleton& skeleton, std::size_t finger, std::size_t joint) {
  return (skeleton.joints[hand_joint(finger, joint)] -
          skeleton.joints[hand_joint(finger, joint - 1)])
      .norm();
}

Result<Skeleton> median_of(std::span<const Skeleton> shots) {
  if (shots.empty()) return fail(ErrorCode::NotFound, "pictures", "show no hand");
  for (const Skeleton& each : shots) {
    if (each.side != shots[0].side)
      return fail(ErrorCode::Conflict, "pictures",
                  "show a left and a right hand; name a folder as --out to scan each on its own");
    if (each.relative != shots[0].relative)
      return fail(ErrorCode::Conflict, "pictures", "have a scale in some and none in others");
  }
  Skeleton out = shots[0];
  const auto middle = [&](auto value) {
    std::vector<double> all;
    for (const Skeleton& each : shots) {
      if (const double v = value(each); std::isfinite(v)) all.push_back(v);
    }
    return all.empty() ? 0.0 : median(std::move(all));
  };
  for (std::size_t i = 1; i < kHandJoints; ++i) {
    const std::size_t parent = layout::kHandTable[i].parent;
    for (Eigen::Index k = 0; k < 3; ++k) {
      out.joints[i][k] = out.joints[parent][k] + middle([&](const Skeleton& s) {
                           return s.joints[i][k] - s.joints[parent][k];
                         });
    }
  }
  for (std::size_t f = 0; f < kFingers; ++f)
    out.widths[f] = middle([&](const Skeleton& s) { return s.widths[f]; });
  out.palm_radius = middle([](const Skeleton& s) { return s.palm_radius; });
  return out;
}

}  // namespace chorus::hand

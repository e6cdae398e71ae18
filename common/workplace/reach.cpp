#include "common/workplace/reach.h"

#include <cmath>
#include <numbers>

namespace chorus::workplace {
namespace {

using Eigen::Vector3d;
using enum JointId;

/// Variance along a direction [m^2]; zero where none is stated.
double variance_along(const Joint& joint, const Vector3d& line) {
  if (!joint.covariance.known() || !(line.norm() > 0.0)) return 0.0;
  const Vector3d unit = line.normalized();
  return unit.dot(joint.covariance.matrix() * unit);
}

struct Length {
  double metres = 0.0;
  double variance = 0.0;
};

Length bone(const Arm& arm, JointId from, JointId to) {
  if (arm.bones != nullptr) {
    const LearnedLength& learned = (*arm.bones)[index_of(to)];
    if (learned.sigma > 0.0) return {learned.length, learned.sigma * learned.sigma};
  }
  const Vector3d line = arm.body[to].position - arm.body[from].position;
  return {line.norm(), variance_along(arm.body[from], line) + variance_along(arm.body[to], line)};
}

double normal_below(double x, double sigma) {
  if (!(sigma > 0.0)) return x > 0.0 ? 1.0 : x < 0.0 ? 0.0 : 0.5;
  return 0.5 * std::erfc(-x / sigma / std::numbers::sqrt2);
}

Within within(double distance, double length, double variance) {
  Within out;
  out.missing = distance - length;
  out.sigma = std::sqrt(variance);
  out.probability = normal_below(-out.missing, out.sigma);
  return out;
}

}  // namespace

Reach reach_of(const Arm& arm, const Vector3d& point, const Scene& scene) {
  const JointId shoulder = arm.left ? ShoulderLeft : ShoulderRight;
  const JointId elbow = arm.left ? ElbowLeft : ElbowRight;
  const JointId wrist = arm.left ? WristLeft : WristRight;
  Reach reach;
  for (const JointId needed : {shoulder, elbow, wrist, HipLeft, HipRight})
    if (!arm.body[needed].seen()) return reach;
  if (!point.allFinite()) return reach;
  reach.known = true;
  const Vector3d& at = arm.body[shoulder].position;
  const Length upper = bone(arm, shoulder, elbow);
  const Length lower = bone(arm, elbow, wrist);
  const double length = upper.metres + lower.metres + kGripBeyondWrist;
  const double variance = upper.variance + lower.variance;
  reach.distance = (point - arm.body[wrist].position).norm();
  reach.arm = within((point - at).norm(), length,
                     variance + variance_along(arm.body[shoulder], point - at));
  const Vector3d hips = 0.5 * (arm.body[HipLeft].position + arm.body[HipRight].position);
  const double trunk = (at - hips).norm();
  const double hip_variance = 0.25 * (variance_along(arm.body[HipLeft], point - hips) +
                                      variance_along(arm.body[HipRight], point - hips));
  const double trunk_variance = hip_variance + variance_along(arm.body[shoulder], at - hips);
  reach.leaning =
      within((point - hips).norm(), trunk + length, variance + hip_variance + trunk_variance);
  reach.blocked_by = obstacle_between(scene, at, point);
  return reach;
}

}  // namespace chorus::workplace

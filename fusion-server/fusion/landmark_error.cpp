#include "fusion-server/fusion/landmark_error.h"

#include <algorithm>

namespace chorus::fusion {

double landmark_error(JointId joint) {
  using enum JointId;
  switch (joint) {
    case ShoulderLeft:
    case ShoulderRight:
      return 0.028;
    case ElbowLeft:
    case ElbowRight:
      return 0.022;
    case WristLeft:
    case WristRight:
    case KneeLeft:
    case KneeRight:
      return 0.018;
    case SpineBase:
    case SpineMid:
    case SpineShoulder:
    case Neck:
    case Head:
    case HipLeft:
    case HipRight:
    case AnkleLeft:
    case AnkleRight:
      return 0.020;
    default:
      return 0.030;
  }
}

bool from_cameras(std::span<const JointView> views) {
  return !views.empty() && std::ranges::all_of(views, [](const JointView& view) {
    return view.joint.bears() || nearly_a_ray(view.joint);
  });
}

void state_landmark_error(FusedJoint& fused, JointId joint) {
  const double least = landmark_error(joint);
  const double lack = least * least - fused.variance;
  if (!fused.joint.seen() || !(lack > 0)) return;
  state_covariance(fused, fused.joint.covariance.matrix() + lack * Eigen::Matrix3d::Identity());
}

}  // namespace chorus::fusion

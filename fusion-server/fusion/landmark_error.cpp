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
      return 0.024;
    case SpineShoulder:
      return 0.022;
    case Head:
      return 0.020;
    case Neck:
    case WristLeft:
    case WristRight:
    case HipLeft:
    case HipRight:
    case AnkleLeft:
    case AnkleRight:
      return 0.016;
    case SpineBase:
      return 0.014;
    case KneeLeft:
    case KneeRight:
      return 0.013;
    case SpineMid:
      return 0.011;
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
  if (!fused.joint.seen()) return;
  const double error = landmark_error(joint);
  state_covariance(fused,
                   fused.joint.covariance.matrix() + error * error * Eigen::Matrix3d::Identity());
}

}  // namespace chorus::fusion

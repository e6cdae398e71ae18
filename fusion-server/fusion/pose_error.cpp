#include "fusion-server/fusion/pose_error.h"

namespace chorus::fusion {
namespace {

double sigma_of(const PoseError& error, JointId joint) {
  using enum JointId;
  switch (joint) {
    case Neck:
    case SpineShoulder:
      return error.neck;
    case SpineBase:
    case SpineMid:
    case Head:
      return error.trunk;
    case ShoulderLeft:
    case ShoulderRight:
    case HipLeft:
    case HipRight:
      return error.girdle;
    case ElbowLeft:
    case ElbowRight:
    case KneeLeft:
    case KneeRight:
      return error.middle;
    case WristLeft:
    case WristRight:
    case AnkleLeft:
    case AnkleRight:
      return error.end;
    default:
      return error.tip;
  }
}

}  // namespace

double pose_variance(const PoseError& error, JointId joint, JointState state) {
  const double factor = state == JointState::Inferred ? error.inferred_factor : 1.0;
  const double sigma = factor * sigma_of(error, joint);
  return sigma * sigma;
}

}  // namespace chorus::fusion

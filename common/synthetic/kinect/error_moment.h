// The true mean square error of each simulated joint, given the body's pose, which joints are
// hidden and which are called inferred, but not the errors that were actually drawn.
//
// A perfect error model would state this error about one sensor's view.  No real sensor knows it
// and no algorithm may use it; the error serves to compute a bound on what fusion can achieve.  For
// a fitted body (fitted_body.h) it is correct to first order.
#pragma once

#include "common/synthetic/kinect/joint_bias.h"
#include "common/synthetic/kinect/joint_error.h"
#include "common/synthetic/kinect/yaw_behaviour.h"

namespace chorus::synthetic::kinect {

/// One matrix per joint, in sensor space, about the joint's true position [m^2].
using Moments = std::array<Eigen::Matrix3d, kJointCount>;

/// One person in front of one sensor, just before random errors are added to the body.
struct Sight {
  const Skeleton<SensorSpace>& exact;
  /// The body with bias, the SDK's labels, and states.
  const Skeleton<SensorSpace>& shown;
  FlipState flip;
  const Stand& stand;
};

/// The moments of the joints that are seen; those of the others mean nothing.
[[nodiscard]] Moments moments_of(const Sight& sight, double time, const Profile& profile,
                                 const ErrorKeys& keys);

/// Writes each seen joint's moment into its covariance.
void confide(Skeleton<SensorSpace>& body, const Moments& moments);

}  // namespace chorus::synthetic::kinect

// How far a simulated joint is off on average: the true mean square of its error, given how the
// body stands, which joints are hidden and which are called inferred, but not which errors were
// drawn.
//
// What a perfect error model would say of a sight.  No sensor knows it and no algorithm may; a
// bound on what combining sights can give is made of it.  Of a fitted body (fitted_body.h) to first
// order.
#pragma once

#include "common/synthetic/kinect/joint_bias.h"
#include "common/synthetic/kinect/joint_error.h"
#include "common/synthetic/kinect/yaw_behaviour.h"

namespace chorus::synthetic::kinect {

/// Sensor space, about the joint's true place [m^2].
using Moments = std::array<Eigen::Matrix3d, kJointCount>;

/// One person before one sensor, just before random errors come to the body.
struct Sight {
  const Skeleton<SensorSpace>& exact;
  const Skeleton<SensorSpace>& shown;  ///< With bias, labels as the SDK has them, states decided.
  FlipState flip;
  const Stand& stand;
};

/// Of every joint that is seen; zero for the others.
[[nodiscard]] Moments moments_of(const Sight& sight, double time, const Profile& profile,
                                 const ErrorKeys& keys);

/// Lets each seen joint bring its moment.
void confide(Skeleton<SensorSpace>& body, const Moments& moments);

}  // namespace chorus::synthetic::kinect

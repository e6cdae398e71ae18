// Robust perspective-n-point: places a person of known shape in front of a camera that knows only
// the directions of the joints.
#pragma once

#include <optional>

#include "common/body/skeleton.h"

namespace chorus {

/// Standard deviations of what place_body() gets.  Those of the shape are the errors of BlazePose
/// on four real cameras (docs/benchmarks/camera.md).
struct PlacingErrors {
  double across = 0.04;  ///< Joints of the shape, across the line of sight [m].
  double along = 0.10;   ///< Joints of the shape, along the line of sight [m].
  double turn = 0.2;     ///< Rotation of the whole shape about any axis [rad].
  double size = 0.12;    ///< The person's size, relative.
  double focal = 0.0;    ///< The focal length, relative.
  double ray = 0.01;     ///< Rays that state no covariance [rad].
};

/// Turns and shifts the shape until its joints lie on their rays: minimises
///   sum rho(|B_i' (R X_i + t)| / s_i) + |log(R R_0')|^2 / turn^2
/// over the rotation R and the shift t by Gauss-Newton.  B_i: two axes across ray i.  s_i: the
/// standard deviation of joint i across its ray, from the errors of ray and shape.  rho: Huber's
/// loss; a last pass leaves out joints beyond 4 s_i.  R_0: the rotation from straight ahead to the
/// mean ray, because networks look at a cut-out around the person.  Each joint keeps the direction
/// of its own ray; only its distance is taken from the shape.
///
/// `rays`: joints as rays, in sensor space, without distortion.  `shape`: joints as points about
/// any origin [m], in axes like sensor space's (x to the left, y up), where z is the line of sight
/// to the person.
///
/// Returns `rays`, where joints that are in `shape` have become points, unless their variance would
/// be too large to be written.  The variance along a ray is the sum of those from the shape, from R
/// and t, and from size and focal length.  The rays do not show the errors of the last two, which
/// move all joints of a person away or nearer by the same fraction.  None when fewer than eight
/// joints have a ray and a place in the shape, or when they fit no body in front of the camera.
[[nodiscard]] std::optional<Skeleton<SensorSpace>> place_body(const Skeleton<SensorSpace>& rays,
                                                              const Skeleton<SensorSpace>& shape,
                                                              const PlacingErrors& errors);

}  // namespace chorus

// Robust perspective-n-point: places a person of known shape in front of a camera that knows only
// the directions of the joints.
#pragma once

#include <optional>

#include "common/body/skeleton.h"

namespace chorus {

/// Standard deviations.  Those of the shape are the errors of BlazePose on four real cameras
/// (docs/benchmarks/camera.md).
struct PlacingErrors {
  double across = 0.04;  ///< Of a joint of the shape, across the line of sight [m].
  double along = 0.10;   ///< The same along it, where a camera sees little [m].
  double turn = 0.2;     ///< Of the whole shape about any axis [rad].
  double size = 0.12;    ///< Of the person's size, relative to it.
  double focal = 0.0;    ///< Of the focal length, relative to it.
  double ray = 0.01;     ///< Of a ray that has no covariance [rad].
};

/// Turns and shifts the shape until its joints lie on their rays: minimises
///   sum rho(|B_i' (R X_i + t)| / s_i) + |log(R R_0')|^2 / turn^2
/// over the rotation R and the shift t by Gauss-Newton.  B_i: two axes across ray i.  s_i: what ray
/// and shape err by there.  rho: Huber's loss, which in the end leaves out joints beyond 4.
/// R_0 turns "ahead" into the mean ray: networks look at a cut-out around the person.  Each joint
/// keeps the direction of its own ray; only its distance is that of the shape.
///
/// `rays`: joints as rays, in sensor space, without distortion.  `shape`: joints as points about
/// any origin [m], in axes like sensor space's (x to the left, y up), where z is the line of sight
/// to the person.
///
/// Returns `rays`, where joints that are in `shape` have become points.  The variance along a ray
/// is the sum of those of the shape, of R and t, and of size and focal length, which rays cannot
/// tell: all joints of a person are too far or too near by the same share.  None when fewer than
/// eight joints are given, or when they fit no body in front of the camera.
[[nodiscard]] std::optional<Skeleton<SensorSpace>> place_body(const Skeleton<SensorSpace>& rays,
                                                              const Skeleton<SensorSpace>& shape,
                                                              const PlacingErrors& errors);

}  // namespace chorus

// Interpolates a body between two instants at which it was seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/body/skeleton.h"

namespace chorus {

/// Interpolates positions linearly (a ray's direction is then normalised) and orientations by a
/// sign-aligned LERP where both are given; the state is the worse of the two; s is in [0, 1].  The
/// result is not tracked when either joint has no position or direction, or when one is a point and
/// the other a ray.
[[nodiscard]] Joint interpolate(const Joint& a, const Joint& b, double s);

/// Interpolates each joint.  `s` is clamped to [0, 1]; it counts as 0 if it is not finite.
template <class Space>
[[nodiscard]] Skeleton<Space> interpolate(const Skeleton<Space>& a, const Skeleton<Space>& b,
                                          double s) {
  const double share = std::isfinite(s) ? std::clamp(s, 0.0, 1.0) : 0.0;
  Skeleton<Space> body;
  for (std::size_t i = 0; i < kJointCount; ++i)
    body.joints[i] = interpolate(a.joints[i], b.joints[i], share);
  return body;
}

}  // namespace chorus

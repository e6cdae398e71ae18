// Interpolates a body between two instants at which it was seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/body/skeleton.h"

namespace chorus {

/// Positions are interpolated linearly (directions of rays are normalised), orientations by a
/// sign-aligned LERP where both exist; the state is the worse one; s is in [0, 1].  Not tracked
/// when either joint has no place, nor between a point and a ray.
[[nodiscard]] Joint interpolate(const Joint& a, const Joint& b, double s);

/// Interpolates each joint.  `s` is clamped to [0, 1]; NaN counts as 0.
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

#include "fusion-server/fusion/quality.h"

#include <cmath>

namespace chorus::fusion {
namespace {

/// 1 at angle zero, falling linearly to 0 at `limit`; NaN gives zero.
Weight falling(double angle, double limit) noexcept {
  if (!(limit > 0)) return Weight::clamped(0);
  return Weight::clamped(1.0 - std::abs(angle) / limit);
}

}  // namespace

Weight distance_weight(double distance, const QualityLimits& limits) noexcept {
  if (!(limits.distance_reach > 0)) return Weight::clamped(0);
  const double off = (distance - limits.best_distance) / limits.distance_reach;
  return Weight::clamped(1.0 - off * off);
}

Weight facing_weight(double facing, const QualityLimits& limits) noexcept {
  return falling(facing, limits.max_facing);
}

Weight bearing_weight(double bearing, const QualityLimits& limits) noexcept {
  return falling(bearing, limits.max_bearing);
}

Weight view_weight(double distance, double facing, double bearing,
                   const QualityLimits& limits) noexcept {
  return distance_weight(distance, limits) * facing_weight(facing, limits) *
         bearing_weight(bearing, limits);
}

}  // namespace chorus::fusion

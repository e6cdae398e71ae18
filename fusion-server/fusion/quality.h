// Quality heuristics: how far one sensor's view of one body may be trusted.
//
// Implements Otto et al., JVRB 13(2016) no. 3, Sect. 5.2.5, Eqs. (1)-(3).
// Pure and defined for every input: every double yields a Weight in [0, 1], and NaN yields zero.
// In metres and radians, measured in the observing sensor's space.
#pragma once

#include "common/base/units.h"
#include "fusion-server/fusion/weight.h"

namespace chorus::fusion {

/// Which bearing Eq. (3) uses: that of the neck or, as the paper's text says, that of the
/// centre-axis joints.
enum class BearingOf { Neck, CentreAxis };

/// Where each heuristic is 1 and where it reaches zero; the published values by default.
struct QualityLimits {
  double best_distance = 2.5;    ///< d of Eq. (1) at which the weight is 1 [m]
  double distance_reach = 1.0;   ///< |d - best_distance| at which it is 0 [m]
  double max_facing = deg(30);   ///< |phi| of Eq. (2) at which it is 0 [rad]
  double max_bearing = deg(25);  ///< |alpha| of Eq. (3) at which it is 0 [rad]
  BearingOf bearing_of = BearingOf::Neck;

  bool operator==(const QualityLimits&) const = default;
};

/// Eq. (1): 1 - (d - 2.5 m)^2 for 1.5 m < d <= 3.5 m, otherwise 0.  Continuous at both ends.
[[nodiscard]] Weight distance_weight(double distance, const QualityLimits& = {}) noexcept;

/// Eq. (2): 1 - |phi| / 30 deg for |phi| <= 30 deg, otherwise 0.  So a rear view (|phi| > 90 deg)
/// is zero.
[[nodiscard]] Weight facing_weight(double facing, const QualityLimits& = {}) noexcept;

/// Eq. (3): 1 - |alpha| / 25 deg for |alpha| <= 25 deg, otherwise 0.
[[nodiscard]] Weight bearing_weight(double bearing, const QualityLimits& = {}) noexcept;

/// Product of Eqs. (1)-(3).  The paper says only that the weights "can be integrated"; taking the
/// product is our decision (docs/decisions).  Any unknown angle or distance (NaN) gives zero.
[[nodiscard]] Weight view_weight(double distance, double facing, double bearing,
                                 const QualityLimits& = {}) noexcept;

}  // namespace chorus::fusion

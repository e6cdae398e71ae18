// Error of a tracked pose beyond its sensor's noise: it changes slowly and grows towards the ends
// of the limbs.  This estimate of its size goes into the stated covariances; only the body filter
// uses a part of it in the weights of the views, too.
#pragma once

#include "common/body/skeleton.h"

namespace chorus::fusion {

/// Standard deviations per axis and view [m], rounded.  Fitted on simulated sensors (profiles A, B
/// and D, seeds from 1001 on; docs/benchmarks/fusion.md, Stated errors).
struct PoseError {
  double neck = 0.0;       ///< Neck, upper end of the spine.
  double trunk = 0.0165;   ///< Spine, head.
  double girdle = 0.022;   ///< Shoulders, hips.
  double middle = 0.0305;  ///< Elbows, knees.
  double end = 0.037;      ///< Wrists, ankles.
  double tip = 0.0455;     ///< Hands, feet, tips, thumbs.
  double inferred_factor = 1.5;

  bool operator==(const PoseError&) const = default;
};

/// Variance per axis [m^2].
[[nodiscard]] double pose_variance(const PoseError& error, JointId joint, JointState state);

}  // namespace chorus::fusion

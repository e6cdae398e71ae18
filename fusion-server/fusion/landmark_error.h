// How far the landmarks that cameras find in pictures are from the joints that they are named
// after.
//
// Networks mean other points than an anatomist: an error of the joint and not of the view, so that
// no number of views makes it smaller.  Views that agree do not show it.
#pragma once

#include <span>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {

/// Standard deviation per axis [m] of the error that all cameras share: what eight cameras have
/// wrong, less what they differ by (docs/benchmarks/camera.md, Stated errors).  Head, hands, feet
/// and thumbs, which nobody has measured, are those of a joint alike or larger.
[[nodiscard]] double landmark_error(JointId joint);

/// True if the views are rays, or points whose depth is hardly known.
[[nodiscard]] bool from_cameras(std::span<const JointView> views);

/// Adds it to the joint's stated covariance, alike on every axis.
void state_landmark_error(FusedJoint& fused, JointId joint);

}  // namespace chorus::fusion

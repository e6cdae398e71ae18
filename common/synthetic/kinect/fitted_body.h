// An SDK that fits a body of fixed proportions: in each frame all bones have their own lengths
// times one common scale.  (Measured on Azure Kinect logs: the lengths of any two bones correlate
// by 1.000000, and the scale is between 0.77 and 1.09.)
//
// Bones keep the directions given by the joints with their errors, but have the lengths of the
// fitted body.  The middle of the trunk stays where the joints with their errors put it.
#pragma once

#include "common/body/bones.h"
#include "common/synthetic/kinect/joint_error.h"

namespace chorus::synthetic::kinect {

/// What one sensor's SDK remembers of one body: its scale, which varies slowly.
struct FitState {
  SmoothNoise scale;
};

/// Ratio of each bone's fitted length to its true one, in the order of kBones.  Constant over time,
/// and equal for left and right.
using Proportions = std::array<double, kBones.size()>;
[[nodiscard]] Proportions proportions_of(const BodyFit& fit, const ErrorKeys& keys);

/// Advances by one frame; the scale changes faster while the trunk moves.
void advance(FitState& state, const Stand& stand, const Moment& moment, const Profile& profile,
             const ErrorKeys& keys);

/// The scale of this frame.
[[nodiscard]] double scale_of(const FitState& state, double time, const BodyFit& fit,
                              const ErrorKeys& keys);

/// Gives the seen bones of the body with errors the lengths of the exact body, times `scale` and
/// each bone's proportion.
[[nodiscard]] Skeleton<SensorSpace> fitted(const Skeleton<SensorSpace>& erring,
                                           const Skeleton<SensorSpace>& exact, double scale,
                                           const Proportions& proportions);

}  // namespace chorus::synthetic::kinect

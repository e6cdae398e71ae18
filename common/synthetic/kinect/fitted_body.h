// A tracker that fits a body of fixed proportions: every bone of a frame has its length times one
// scale (Azure Kinect, measured: two bones' lengths correlate by 1.000000, one scale in 0.77-1.09).
//
// Bones keep the directions that the erring joints give them; lengths are the fitted body's.  The
// middle of the trunk stays where the erring joints have it.
#pragma once

#include "common/body/bones.h"
#include "common/synthetic/kinect/joint_error.h"

namespace chorus::synthetic::kinect {

/// Memory of one body in one sensor: what its scale does.
struct FitState {
  SmoothNoise scale;
};

/// Lengths of the bones over the true ones, in the order of kBones: for good, left as right.
using Proportions = std::array<double, kBones.size()>;
[[nodiscard]] Proportions proportions_of(const BodyFit& fit, const ErrorKeys& keys);

/// One frame further: the scale wanders as the trunk moves.
void advance(FitState& state, const Stand& stand, const Moment& moment, const Profile& profile,
             const ErrorKeys& keys);

/// The scale of this frame.
[[nodiscard]] double scale_of(const FitState& state, double time, const BodyFit& fit,
                              const ErrorKeys& keys);

/// Gives the seen bones of an erring body the lengths of the exact one times `scale` and their
/// proportion.
[[nodiscard]] Skeleton<SensorSpace> fitted(const Skeleton<SensorSpace>& erring,
                                           const Skeleton<SensorSpace>& exact, double scale,
                                           const Proportions& proportions);

}  // namespace chorus::synthetic::kinect

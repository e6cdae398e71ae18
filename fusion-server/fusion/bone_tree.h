// Moves joints so that the lengths of the bones fit: the body as a tree.
//
//   min  sum_j |x_j - z_j|^2_S_j + sum_b (|x_c - x_p| - L_b)^2 / s_b^2
// (docs/papers/body.md (4)) by Gauss-Newton, each step solved exactly from the leaves to the root
// and back (5)-(7).
#pragma once

#include <array>

#include <Eigen/Core>

#include "common/body/bones.h"

namespace chorus::fusion {

/// Position of a joint, according to the views of one instant or to everything known.
struct PlacedJoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2], positive definite if placed.
  bool placed = false;
};
using PlacedBody = std::array<PlacedJoint, kJointCount>;

/// The length of a bone.
struct HeldBone {
  double length = 0.0;  ///< [m]
  double sigma = 0.0;   ///< Standard deviation [m]; 0: unknown length.
};
using HeldBones = std::array<HeldBone, kBones.size()>;  ///< In the order of kBones.

/// Joints without a position stay without one; their bones, and bones of unknown length, have no
/// effect.  Two rounds of Gauss-Newton suffice if the body nearly fits the bones; one is enough if
/// the result is only a start.
[[nodiscard]] PlacedBody hold_bones(const PlacedBody& seen, const HeldBones& bones, int rounds = 2);

}  // namespace chorus::fusion

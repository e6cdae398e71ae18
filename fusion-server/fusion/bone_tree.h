// Moves joints so that the lengths of the bones fit: the body as a tree.
//
//   min  sum_j |x_j - z_j|^2_S_j + sum_b (|x_c - x_p| - L_b)^2 / s_b^2
// (docs/papers/body.md (4)) by Gauss-Newton, each step solved exactly from the leaves to the root
// and back (5)-(7).  A bone whose direction is known too, from an inertial sensor on the limb, is
//   + |x_c - x_p - w_b|^2_W_b
// instead (docs/papers/body.md (23)): linear, solved in the same pass.
#pragma once

#include <array>
#include <optional>

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

/// Length and direction of a bone.
struct HeldWay {
  Eigen::Vector3d way = Eigen::Vector3d::Zero();         ///< From parent to child [m].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2], positive definite.
};

/// The length of a bone, and its direction where that is known.
struct HeldBone {
  double length = 0.0;              ///< [m]
  double sigma = 0.0;               ///< Standard deviation [m]; 0: unknown length.
  std::optional<HeldWay> way = {};  ///< Takes the place of the length.
};

/// The way along a unit direction whose own covariance is given [1], for a bone of known length.
[[nodiscard]] HeldWay held_way(const HeldBone& bone, const Eigen::Vector3d& direction,
                               const Eigen::Matrix3d& covariance);
using HeldBones = std::array<HeldBone, kBones.size()>;  ///< In the order of kBones.

/// Joints without a position stay without one; their bones, and bones of unknown length, have no
/// effect.  Two rounds of Gauss-Newton suffice if the body nearly fits the bones; one is enough if
/// the result is only a start.
[[nodiscard]] PlacedBody hold_bones(const PlacedBody& seen, const HeldBones& bones, int rounds = 2);

}  // namespace chorus::fusion

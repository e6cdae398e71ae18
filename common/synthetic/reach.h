// A hand that reaches for a point, out of an arm that hangs or swings: two bones, lengths kept.
//
// Walk frame of one person: origin on the floor under the body, +z to the front, +y up, +x to the
// left; metres of somebody as tall as the recorded subject.
#pragma once

#include "common/body/skeleton.h"

namespace chorus::synthetic {

struct Reach {
  bool left = false;                                 ///< Which hand.
  double amount = 0.0;                               ///< 0: not at all, 1: the wrist is there.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< For the wrist [m]
};

/// Moves elbow, wrist and hand; the hand stretches towards a target that is too far away.
void apply(const Reach& reach, Skeleton<WorldSpace>& body);

}  // namespace chorus::synthetic

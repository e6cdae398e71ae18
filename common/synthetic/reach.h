// Makes a hanging or swinging arm reach for a point; the lengths of its two bones are kept.
//
// All points are in the walk frame of one person: origin on the floor under the body, +z to the
// front, +y up, +x to the left; metres for a person as tall as the recorded subject.
#pragma once

#include "common/body/skeleton.h"

namespace chorus::synthetic {

struct Reach {
  bool left = false;    ///< True for the left hand.
  double amount = 0.0;  ///< 0: the arm is unchanged, 1: the wrist is at the target.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< Target of the wrist [m]
};

/// Moves elbow, wrist and hand.  If the target is too far from the shoulder or too near to it, the
/// wrist stops at the arm's limit, in the direction of the target.
void apply(const Reach& reach, Skeleton<WorldSpace>& body);

}  // namespace chorus::synthetic

// Lets a body stay where it was expected when others than before place it, and follow them soon.
//
// Several cameras, one of them, another one, depth sensors: each has the body elsewhere by what it
// errs.  What a joint is off by at the change fades:                  docs/papers/rays.md
//   o <- (o + expected - placed at a change) e^(-dt / tau)
#pragma once

#include <array>

#include "fusion-server/flow/fused_body.h"
#include "fusion-server/fusion/bone_tree.h"

namespace chorus::fusion {

class SourceFade {
 public:
  /// Moves the joints by what is left of their offsets, which the stated covariance then includes;
  /// `changed`: others than before place the body, which was expected at `expected`; `passed`:
  /// since the last call [s].
  void apply(FusedBody& body, const PlacedBody& expected, bool changed, double passed);

 private:
  std::array<Eigen::Vector3d, kJointCount> offsets_ = [] {
    std::array<Eigen::Vector3d, kJointCount> none;
    none.fill(Eigen::Vector3d::Zero());
    return none;
  }();
};

}  // namespace chorus::fusion

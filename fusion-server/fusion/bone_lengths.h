// The lengths of one person's bones, learned while the person is seen.
//
// Each instant gives a length with the variance of its two ends.  Errors are alike for about half a
// second, so that much time counts as one independent sight; old sights fade.  Both sides of a body
// are taken to be alike: docs/papers/body.md (8).
#pragma once

#include <array>

#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/bone_tree.h"

namespace chorus::fusion {

class BoneLengths {
 public:
  /// Of an instant, `passed` [s] after the one before.
  void learn(const PlacedBody& seen, double passed, const BodyModel& model);
  [[nodiscard]] HeldBones held(const BodyModel& model) const;

 private:
  struct Learned {
    double length = 0.0;  ///< [m]
    double weight = 0.0;  ///< Sum of passed time over variance [s / m^2].
  };
  std::array<Learned, kBones.size()> bones_;
};

}  // namespace chorus::fusion

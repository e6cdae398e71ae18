// The lengths of one person's bones, learned while the person is seen.
//
// Each instant yields a length, with the variance of both ends.  Errors stay the same for about
// half a second, so all instants within half a second count as one independent measurement; old
// measurements fade.  Both sides of a body are assumed to be of equal size: docs/papers/body.md
// (8).
#pragma once

#include <array>

#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/bone_tree.h"

namespace chorus::fusion {

class BoneLengths {
 public:
  /// Takes the body of an instant, `passed` [s] after the previous one.
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

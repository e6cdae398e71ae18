// Feet and hands, held near where they usually are on their limb.
//
// Trackers are worst at them, and their errors change within a tenth of a second, which no filter
// can tell from motion.  But a foot turns little on the shank, and a hand on the forearm:
//   x <- x + k (a + M m - x),   k = S / (S + S_a + (limb_end |m|)^2)     docs/papers/body.md (18)
// with a the ankle or wrist, M the axes of the limb, m the usual way from a to the joint in those
// axes, and S, S_a the stated variances of both joints.  m and its scatter are learned.  A scatter
// that the views' errors do not explain takes the place of (limb_end |m|)^2 if it is larger, and k
// falls where the views are far from m, so that unusual motion is not held back.
#pragma once

#include <array>

#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/bone_tree.h"

namespace chorus::fusion {

/// Stated variance of each joint according to its views, per axis [m^2]; 0: the joint is left out.
using StatedVariances = std::array<double, kJointCount>;

class LimbEnds {
 public:
  /// Learns from `seen`, the joints according to the views alone, `passed` [s] after the previous
  /// instant.
  void learn(const PlacedBody& seen, const StatedVariances& stated, double passed,
             const BodyModel& model);
  /// The body with its feet and hands moved towards where they usually are.
  [[nodiscard]] PlacedBody held(PlacedBody body, const StatedVariances& stated,
                                const BodyModel& model);
  /// By what factor the last held() has changed the joint's stated variance.
  [[nodiscard]] double left(std::size_t joint) const { return left_[joint]; }

 private:
  struct Usual {
    Eigen::Vector3d way = Eigen::Vector3d::Zero();  ///< m [m]
    double scatter = 0.0;  ///< Its variance among the views' ways, per axis [m^2].
    double weight = 0.0;   ///< Sum of passed time over variance [s / m^2].
  };
  std::array<Usual, kJointCount> usual_;
  std::array<double, kJointCount> left_ = [] {
    std::array<double, kJointCount> all;
    all.fill(1.0);
    return all;
  }();
};

}  // namespace chorus::fusion

// Lets inertial sensors that a person wears steer the limbs of the fused body.
//
// A sensor knows the direction of its limb's bone, whatever the views see.  With the bone's length,
// learned while both ends are seen, that is one more measurement between two joints, and all are
// solved in one pass over the tree of bones (bone_tree.h):                docs/papers/body.md (23)
//   w = L u + o,   W = L^2 [u]x C [u]x^T + s_L^2 u u^T
// with u the sensor's direction, C the covariance of its orientation, o what the bone was last seen
// to differ from it (only while it is hidden, fading).
//
// Works behind every method: a joint that the views show is a point with the covariance that the
// method states.  A hidden joint goes on by its sensor as long as its parent has a place; it is
// Inferred then.  Where views and sensor disagree, the sensor counts less (Geman-McClure's weight)
// and the stated covariance grows by half the square of what they differ by, since either may be
// right.
#pragma once

#include <array>
#include <optional>

#include "common/time/timestamp.h"
#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/fusion/bone_lengths.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

/// The memory of one person; a value.
class InertialLimbs {
 public:
  /// `body`: the person's body at `instant` according to the views.  Unchanged without
  /// Person::worn, apart from what is learned of the bones.
  [[nodiscard]] FusedBody steer(FusedBody body, const Person& person, Timestamp instant,
                                const FusionConfig& config);

 private:
  /// A bone whose limb wears a sensor.
  struct Steered {
    const WornLimb* worn = nullptr;
    HeldWay way;
    double trust = 1.0;  ///< Of the sensor beside the views, in [0, 1].
    Eigen::Vector3d apart = Eigen::Vector3d::Zero();  ///< Sensor minus views [m].
  };
  using SteeredBones = std::array<Steered, kBones.size()>;

  [[nodiscard]] SteeredBones steered(const Person& person, const PlacedBody& seen,
                                     const HeldBones& lengths, const InertialModel& model) const;
  /// Where sensors lead what has been hidden until this instant, if it still were [m].
  using Led = std::array<std::optional<Eigen::Vector3d>, kJointCount>;
  [[nodiscard]] PlacedBody reached(const PlacedBody& seen, SteeredBones& bones, double passed,
                                   const InertialModel& model, Led& led);
  void state(FusedBody& body, const PlacedBody& whole, const SteeredBones& bones,
             const PlacedBody& seen);
  void carry_on(FusedBody& body, const PlacedBody& seen, double passed);

  BoneLengths lengths_;
  /// Of a seen joint: how far it is from where its sensor has it.  Of a hidden one: what is left of
  /// that.  [m]
  std::array<Eigen::Vector3d, kJointCount> off_ = zeros();
  std::array<Eigen::Vector3d, kJointCount> handback_ = zeros();  ///< Added to a seen joint [m].
  std::array<bool, kJointCount> by_sensor_{};  ///< At the last instant a hidden joint with a place.
  std::array<std::optional<Timestamp>, kJointCount> seen_at_;
  std::array<std::optional<Eigen::Vector3d>, kJointCount> last_;  ///< Places that were published.
  std::optional<Timestamp> at_;

  static std::array<Eigen::Vector3d, kJointCount> zeros() {
    std::array<Eigen::Vector3d, kJointCount> none;
    none.fill(Eigen::Vector3d::Zero());
    return none;
  }
};

}  // namespace chorus::fusion

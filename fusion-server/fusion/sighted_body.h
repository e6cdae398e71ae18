// All views of one person at one instant, put together into one body.
//
// The joints, the bones and what each view errs by as a whole depend on each other; each in turn is
// solved for while the others are held (docs/papers/body.md (1)-(3)).  No memory.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/fusion/bone_tree.h"
#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"
#include "fusion-server/fusion/joint_view.h"
#include "fusion-server/fusion/view_misfit.h"

namespace chorus::fusion {

/// What each sensor has each joint off by [m]; empty joints of a sensor are zero.
using Biases = std::map<SensorId, std::array<Eigen::Vector3d, kJointCount>>;

class SightedBody {
 public:
  /// `biases` are taken off the points.
  SightedBody(const Person& person, const Instant& instant, const ErrorModel& errors,
              const FusionConfig& config, const Biases& biases);

  /// Solves for everything, bones held to their lengths where these are known.  `expected`: where
  /// joints should be, which bounds those that too few rays show.
  void settle(const HeldBones& bones, const PlacedBody& expected);

  /// The joints as the mended views have them, bones let go.
  [[nodiscard]] const PlacedBody& placed() const { return placed_; }
  /// Has the joint its place from views alone?
  [[nodiscard]] bool determined(std::size_t joint) const;
  /// After so much time [s]: the biases follow what is left of the points beside the body.
  void learn(Biases& biases, const PlacedBody& body, double passed) const;
  /// State, orientation and contributors of a joint; its place is not set.
  [[nodiscard]] FusedJoint shown(JointId joint) const;

 private:
  /// A joint's views, mended, and how far each is trusted.
  struct Sights {
    std::vector<JointView> views;
    std::vector<double> variance;  ///< Per axis [m^2].
    std::vector<double> trust;
    bool round = true;     ///< Points whose errors are alike on all axes.
    bool bounded = false;  ///< By where the joint should be, not by views alone.
  };

  void take(std::size_t joint, const Instant& instant, const ErrorModel& errors,
            const Biases& biases);
  void place_all(const PlacedBody& expected, const PlacedBody* start);
  [[nodiscard]] PlacedJoint robust_mean(Sights& sights, const PlacedJoint* start) const;
  [[nodiscard]] PlacedJoint robust_squares(Sights& sights, const PlacedJoint& expected) const;
  void mend(const PlacedBody& body);

  const FusionConfig& config_;
  const Person& person_;
  std::vector<SeenBody> seen_;
  std::vector<Misfit> misfits_;
  std::array<Sights, kJointCount> sights_;
  PlacedBody placed_;
};

}  // namespace chorus::fusion

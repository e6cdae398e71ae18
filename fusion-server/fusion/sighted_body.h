// Combines all views of one person at one instant into one body.
//
// The joints, the bones and the error of each view as a whole depend on each other; so each in turn
// is solved for while the others are fixed (docs/papers/body.md (1)-(3)).  No memory.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "fusion-server/fusion/bone_tree.h"
#include "fusion-server/fusion/disagreement.h"
#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"
#include "fusion-server/fusion/handover.h"
#include "fusion-server/fusion/joint_view.h"
#include "fusion-server/fusion/limb_ends.h"
#include "fusion-server/fusion/view_misfit.h"

namespace chorus::fusion {

/// The learned error of each joint's position in each sensor [m]; zero if none was learned.
using Biases = std::map<SensorId, std::array<Eigen::Vector3d, kJointCount>>;

class SightedBody {
 public:
  /// `biases` are subtracted from the points.
  SightedBody(const Person& person, const Instant& instant, const ErrorModel& errors,
              const FusionConfig& config, const Biases& biases);

  /// Solves for joints, bones and misfits.  `model` contains the sizes of misfits found so far;
  /// bones of known length keep it.  `expected`: predicted positions, which limit the depth of
  /// joints shown by too few rays.
  void settle(const HeldBones& bones, const PlacedBody& expected, const BodyModel& model);

  /// The joints according to the corrected views, without the constraint of the bones.
  [[nodiscard]] const PlacedBody& placed() const { return placed_; }
  /// Covariance of a joint's position according to the views.  The bones' lengths are not used,
  /// because they were learned from the same views, which may agree on wrong lengths.
  [[nodiscard]] Eigen::Matrix3d stated(std::size_t joint) const;
  /// stated() per axis of the joints that views determine by points without a covariance of their
  /// own.
  [[nodiscard]] StatedVariances stated_variances() const;
  [[nodiscard]] const std::vector<Misfit>& misfits() const { return misfits_; }
  /// common_turn() of the views [rad].
  [[nodiscard]] double turn_sigma() const { return turn_sigma_; }
  /// True if the views alone determine the joint's position.
  [[nodiscard]] bool determined(std::size_t joint) const;
  /// Updates the biases from the points' residuals against `body`, `passed` [s] after the last
  /// call, since when the person has turned by `turned` [rad].
  void learn(Biases& biases, const PlacedBody& body, double passed, double turned) const;
  /// How the views take part in the means of placed().
  [[nodiscard]] std::vector<ViewPulls> pulls() const;
  /// Squared distances of the points, biases included, from placed(), per axis, in units of the
  /// points' stated variances; only of joints that several views show, all as points without a
  /// covariance of their own.
  [[nodiscard]] ShownDifferences disagreement() const;
  /// Number of views that show a joint as points without a covariance of their own; 0 if a view
  /// shows a ray or states a covariance.
  [[nodiscard]] std::size_t plain_views(std::size_t joint) const;
  /// Mean square of the views' scale errors; none if fewer than two views have points.
  [[nodiscard]] std::optional<double> scale_square() const;
  /// State, orientation, contributors and their shares of a joint; its position is not set.
  [[nodiscard]] FusedJoint shown(JointId joint) const;

 private:
  /// How one view of a joint counts.
  struct Weighing {
    double variance = 0.0;                           ///< Variance per axis, for the weights [m^2].
    double stated = 0.0;                             ///< Variance per axis, with the whole pose
                                                     ///< error [m^2].
    Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< The bias that was subtracted [m].
    double doubt = 0.0;  ///< The part of both variances that is due to the view's turn [m^2].
    double trust = 1.0;
    double pull = 0.0;  ///< In proportion to the view's share in the position.
  };
  /// A joint's views, corrected, and how far each is trusted.
  struct Sights {
    std::vector<JointView> views;
    std::vector<Weighing> weighings;  ///< One for each of `views`.
    bool round = true;                ///< True if all views are points with isotropic errors.
    bool bounded = false;             ///< True if the views alone do not determine the position.
  };
  using Offsets = std::array<Eigen::Vector3d, kJointCount>;

  void take(std::size_t view, std::uint64_t contributor, const ErrorModel& errors,
            const Offsets* biases);
  [[nodiscard]] Weighing weighed(JointView& view, JointId joint, const Offsets* biases) const;
  void place_all(const PlacedBody& expected, const PlacedBody* start);
  [[nodiscard]] PlacedJoint robust_mean(Sights& sights, const PlacedJoint* start) const;
  [[nodiscard]] PlacedJoint robust_squares(Sights& sights, const PlacedJoint& expected) const;
  void mend(const PlacedBody& body, const BodyModel& model);
  void doubt(Sights& sights, const BodyModel& model) const;

  const FusionConfig& config_;
  const Person& person_;
  std::vector<SeenBody> seen_;
  std::vector<Misfit> misfits_;
  std::array<Sights, kJointCount> sights_;
  PlacedBody placed_;
  double turn_sigma_ = 0.0;
};

}  // namespace chorus::fusion

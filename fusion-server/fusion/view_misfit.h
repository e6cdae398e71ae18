// The error of one view's body as a whole: its size, and its turn.
//
// A tracker that fits a body of its own proportions scales all bones of a frame wrongly by one
// ratio; one that sees a body from the side takes it to be turned towards itself (Otto et al. 3.2).
// Neither averages out over joints, so each is a normally distributed nuisance of the view:
//   z_j = x_j + s (x_j - c) + t (up x (x_j - a_j)) + e_j
// (docs/papers/body.md (2)) with c the middle of the trunk and a_j the upper or lower end of the
// spine.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "common/body/skeleton.h"
#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/bone_tree.h"

namespace chorus::fusion {

/// The joints of one view.
struct SeenBody {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Position of the sensor [m].
  std::array<Eigen::Vector3d, kJointCount> place{};
  /// Inverse covariance [1/m^2]; zero: the joint is not seen as a point.
  std::array<Eigen::Matrix3d, kJointCount> information;

  SeenBody() { information.fill(Eigen::Matrix3d::Zero()); }
  [[nodiscard]] bool has(std::size_t joint) const { return information[joint](0, 0) > 0; }
};

struct Misfit {
  double scale = 0.0;
  double turn = 0.0;            ///< About +y [rad].
  double scale_variance = 0.0;  ///< Variance of the found scale; 0: nothing was found.
  double turn_variance = 0.0;   ///< [rad^2]
  double side_on = 0.0;         ///< 0 if seen frontally, 1 from the side; see BodyModel::turn_from.
};

/// Standard deviation of the turn of the body that no comparison of views can show [rad]: that of
/// the view nearest to frontal.  It does not fall with the number of views, because opposite
/// sensors see a body equally side-on and turn it the same way.  0 without views that have a
/// misfit.
[[nodiscard]] double common_turn(std::span<const Misfit> misfits, const BodyModel& model);

/// What a turn of `sigma` [rad] about the spine means for a joint's position [m^2]; zero for joints
/// of the spine.
[[nodiscard]] Eigen::Matrix3d turn_covariance(std::size_t joint, const PlacedBody& body,
                                              double sigma);

/// Mean of the core joints that have a place; none without any.
[[nodiscard]] std::optional<Eigen::Vector3d> middle_of(const PlacedBody& body);

/// The most likely misfit, given the positions of the joints, by one step from `before`; robust
/// against outlying joints.
[[nodiscard]] Misfit misfit_of(const SeenBody& seen, const PlacedBody& body, const Misfit& before,
                               const BodyModel& model);

/// The view's positions, corrected for the misfit.
[[nodiscard]] std::array<Eigen::Vector3d, kJointCount> mended(const SeenBody& seen,
                                                              const PlacedBody& body,
                                                              const Misfit& misfit);

}  // namespace chorus::fusion

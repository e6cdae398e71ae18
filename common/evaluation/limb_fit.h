// How well what is seen of a limb fits the orientation that a worn sensor says of it, with left and
// right as they are labelled and with left and right exchanged.
//
// Of arms and legs the direction of the bone is compared, of pelvis and chest the line through the
// hips or shoulders, right to left: what changes when sides are exchanged.  The head says nothing.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "common/body/skeleton.h"
#include "common/inertial/limb.h"

namespace chorus::evaluation {

/// What a worn sensor says: axes as in limb_frame.h.
struct LimbSaid {
  inertial::Limb limb = inertial::Limb::Pelvis;
  Eigen::Quaterniond world_from_limb = Eigen::Quaterniond::Identity();
  /// Of its rotation vector about the axes of the world [rad^2].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Squared angles between what is seen and what is said, each by its variance: about 1 where they
/// are of one limb, at most kWorstFit, because beyond three sigma either may be anything.
struct LimbFit {
  double labelled = 0.0;
  double exchanged = 0.0;
};
inline constexpr double kWorstFit = 9.0;

/// `sight`: the unit vector along which what is seen has no depth (a camera's rays, in world axes,
/// or a figure that stands in for them); then only what both show across it is compared.  Zero: the
/// joints have places.  None where the limb, or its mirror image, is not seen, or points along
/// `sight`.
[[nodiscard]] std::optional<LimbFit> limb_fit(
    const Skeleton<WorldSpace>& seen, const LimbSaid& said,
    const Eigen::Vector3d& sight = Eigen::Vector3d::Zero());

}  // namespace chorus::evaluation

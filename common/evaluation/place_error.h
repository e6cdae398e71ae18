// The same faults by position: the measure that trackers are usually judged by (Baak et al., 1 and
// 4), beside the distance of orientations.
//
// A position error needs what a take with sensors alone has not: a reference (markers) in the
// tracker's time and world.  A limb that is turned about its bone leaves its joints where they are,
// so its position error shows nothing.
#pragma once

#include <optional>
#include <vector>

#include "common/body/skeleton.h"
#include "common/evaluation/referee.h"

namespace chorus::evaluation {

/// One person over time, in order of time.
using BodyTrack = std::vector<Timed<Skeleton<WorldSpace>>>;

/// Distance of the limb's joints (bone_of) between tracker and reference [m], a mean over those
/// that both show, at the tracker's instants.  The reference is interpolated over 0.1 s at most.
/// Instants at which neither joint is shown by both are left out.
[[nodiscard]] Signal place_errors(inertial::Limb limb, const BodyTrack& tracked,
                                  const BodyTrack& reference);

/// How far a measure tells faults from the rest.
struct FaultContrast {
  double outside = 0.0;          ///< Median where the tracker is right; 0 of nothing.
  double inside = 0.0;           ///< Median in the faults.
  std::optional<double> area{};  ///< Under the ROC curve: 0.5 is chance; none without faults.
};

/// One limb's position error, and the same faults of the tracker by both measures.
struct PlacedLimb {
  inertial::Limb limb = inertial::Limb::Pelvis;
  Signal errors;       ///< [m], at instants that the referee has judged.
  ErrorSpread spread;  ///< [m]
  /// Where the tracker's limb is farther than tau from the reference's (Eq. 13, hysteresis).
  std::vector<Segment> faults;
  FaultContrast angle;  ///< d_quat of tracker and sensor [rad], which needs no reference.
  FaultContrast place;  ///< The position error [m].
};

/// `refereed` and `judged` are of one limb; `places` are its place_errors().
[[nodiscard]] PlacedLimb placed_limb(const RefereedLimb& refereed, const JudgedLimb& judged,
                                     const Signal& places, double tau);

}  // namespace chorus::evaluation

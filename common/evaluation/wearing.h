// Which sensor sits on which limb, and of several people which one wears the suit.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/evaluation/calibrate.h"
#include "common/evaluation/orientation_pair.h"
#include "common/inertial/limb.h"

namespace chorus::evaluation {

/// A limb's orientation over time as a tracker gives it.
using TrackedLimb = std::vector<Timed<TrackedOrientation>>;
/// One person's limbs.
using TrackedBody = std::map<inertial::Limb, TrackedLimb>;

struct WornSensor {
  std::string name;
  OrientationTrack track;  ///< In the tracker's time.
};

/// The pairs of one limb and one sensor, at the tracker's instants.
[[nodiscard]] OrientationPairs pairs_of(const TrackedLimb& limb, const OrientationTrack& sensor);

struct WearingOptions {
  /// Of each sensor with each limb, so with few instants.
  CalibrateOptions calibrate = {.most_pairs = 100};
  /// Two limbs whose exchange costs less than this in residual, both together, are ambiguous [rad].
  double least_margin = deg(3.0);
  /// A person must fit better than the next by this factor.
  double least_ratio = 1.5;
};

/// The limb of each sensor, by the least sum of calibration residuals over all assignments.
/// Refused, naming the limbs and the movement that would decide, where an exchange of two costs too
/// little.
[[nodiscard]] Result<std::vector<inertial::Limb>> worn_on(const std::vector<WornSensor>& sensors,
                                                          const TrackedBody& body,
                                                          const WearingOptions& options = {});

/// Index of the person whose limbs fit the sensors.  Refused if two fit alike, as while all stand
/// still.
[[nodiscard]] Result<std::size_t> worn_by(const std::vector<WornSensor>& sensors,
                                          const std::vector<inertial::Limb>& limbs,
                                          const std::vector<TrackedBody>& people,
                                          const WearingOptions& options = {});

/// Least-cost assignment of rows to columns (H. W. Kuhn 1955, in the form of successive shortest
/// paths); rows at most columns.  Column of each row.
[[nodiscard]] std::vector<std::size_t> least_cost(const std::vector<std::vector<double>>& cost);

}  // namespace chorus::evaluation

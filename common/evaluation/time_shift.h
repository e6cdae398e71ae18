// Time alignment of a tracker and the sensors of one clock, from motion alone.
//
// The paper correlates |acceleration| (4, "Data Acquisition"); here the same correlation serves
// |angular rate| too, which needs one derivative less and no lever arm.  All sensors of one clock
// are correlated jointly.
#pragma once

#include <vector>

#include "common/base/result.h"
#include "common/evaluation/orientation_pair.h"

namespace chorus::evaluation {

using Signal = std::vector<Timed<double>>;

/// |angular rate| [rad/s]: the angle between the orientations `half_window` [s] before and after.
/// Both worlds get the same window, so that smoothing shifts neither.
[[nodiscard]] Signal angular_rates(const OrientationTrack& track, double half_window);

/// |acceleration| [m/s^2] of a point by second differences over `half_window` [s] (tracking world).
[[nodiscard]] Signal accelerations(const std::vector<Timed<Eigen::Vector3d>>& places,
                                   double half_window);

/// The same quantity from both worlds for one limb.
struct SignalPair {
  Signal tracked;
  Signal inertial;
};

struct TimeShift {
  double shift = 0.0;        ///< tracked time = inertial time + shift [s].
  double sigma = 0.0;        ///< Standard error [s], by leaving out parts of the take in turn.
  double correlation = 0.0;  ///< At the shift, -1 to 1.
};

struct TimeShiftOptions {
  double largest = 2.0;  ///< Shifts up to this are tried [s].
  double step = 0.005;   ///< Of the search [s]; a parabola finds the rest.
  /// Below this, the two worlds do not move alike: refused.
  double least_correlation = 0.5;
};

/// The shift at which all pairs together agree best.  Refused, with what to do, if the take is too
/// short, nothing moves, or the best shift lies at the end of the search.
[[nodiscard]] Result<TimeShift> find_time_shift(const std::vector<SignalPair>& pairs,
                                                const TimeShiftOptions& options = {});

/// The orientation at `time` between two samples at most `gap` [s] apart; nothing outside.
[[nodiscard]] std::optional<Eigen::Quaterniond> orientation_at(const OrientationTrack& track,
                                                               double time, double gap = 0.1);

}  // namespace chorus::evaluation

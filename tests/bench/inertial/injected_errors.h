// Errors of a tracker, made on purpose, and the baselines that look for them (Fig. 9).
#pragma once

#include <random>
#include <vector>

#include "common/evaluation/limb_error.h"
#include "common/evaluation/time_shift.h"

namespace chorus::bench {

/// About which axes of the limb a tracker is wrong: the bone shows in no position.
enum class ErrorAxis { Any, Bone, Across };

struct ErrorPlan {
  double from = 0.0;    ///< Before this, bursts that a calibration meets; then errors to find [s].
  double length = 1.5;  ///< Of an error [s]; there is one in three seconds.
  ErrorAxis axis = ErrorAxis::Any;
};

struct InjectedErrors {
  evaluation::OrientationPairs pairs;
  std::vector<evaluation::Segment> truth;
};

/// Turns the limb during the segment.
void turn_limb(evaluation::OrientationPairs& pairs, const evaluation::Segment& when,
               const Eigen::Quaterniond& off);

/// 55 to 150 degrees: the paper's tau and ten more.
[[nodiscard]] Eigen::Quaterniond drawn_error(std::mt19937_64& draw, ErrorAxis axis);

/// A quarter of the instants before `from` is wrong in bursts of half a second; after it one error
/// in three seconds.
[[nodiscard]] InjectedErrors with_errors(evaluation::OrientationPairs pairs, const ErrorPlan& plan,
                                         std::mt19937_64& draw);

/// |difference of the angular rates| of tracker and sensor from `from` on.
[[nodiscard]] evaluation::Signal rate_differences(const evaluation::OrientationPairs& pairs,
                                                  double from);

/// |difference| of two signals of one limb from `from` on, at the first one's times.
[[nodiscard]] evaluation::Signal differences(const evaluation::Signal& tracked,
                                             const evaluation::Signal& sensed, double from);

}  // namespace chorus::bench

// Compares two recordings of one motion joint by joint, and says "different" only when it is.
//
// A is the reference.  B is brought to A's clock and world first: the lag that the motion itself
// shows, and one rigid transform.  Differences of consecutive frames depend on one another, so
// confidence intervals come from the means of blocks (batch means; Law & Kelton, Simulation
// Modeling and Analysis, 9.5.3), and the level is divided by the number of questions (Bonferroni).
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/body/skeleton.h"

namespace chorus::comparison {

struct Moment {
  double time = 0.0;  ///< [s], by the recording's own clock
  Skeleton<WorldSpace> body;
};
/// One person over time, in order of time.
using Track = std::vector<Moment>;
using People = std::map<std::uint64_t, Track>;

struct CompareOptions {
  bool same_clock = false;   ///< The lag is 0; else it is found.
  bool same_world = false;   ///< No transform; else one is fitted.
  bool other_world = false;  ///< The worlds have nothing in common: a transform is no difference.
  /// Largest lag that is looked for [s]; none: the clocks have nothing in common: any lag at which
  /// the two overlap, and it is no difference.
  std::optional<double> clock_range = 2.0;
  /// Length of a block [s]; shorter if there would be fewer than ten.  Some times as long as errors
  /// last: with five times, an interval of 90 % holds 84 %; with ten times, 88 %.
  double block = 5.0;
  double least = 0.001;       ///< Smallest difference of places that counts [m] ...
  double least_turn = 0.002;  ///< ... and of turns [rad].
  double confidence = 0.99;   ///< Of all questions together.
  double max_gap = 0.1;       ///< Longest hole of B that is interpolated [s].
};

/// A mean with its confidence interval mean +- half.
struct Estimate {
  double mean = 0.0;
  double half = 0.0;
  /// The interval leaves out zero, and the mean is at least `least`.
  [[nodiscard]] bool differs(double least) const {
    return !(std::abs(mean) <= half) && std::abs(mean) >= least;
  }
};

/// A's joint minus B's, after B was brought into A's world, in A's axes [m].
struct JointDifference {
  std::size_t frames = 0;  ///< In which both see the joint.
  std::array<Estimate, 3> offset;
  double rms = 0.0;
  double p95 = 0.0;         ///< Of the distance.
  Estimate drift;           ///< Change of the distance per minute.
  double limit_low = 0.0;   ///< Bland-Altman limits of agreement of the height (y):
  double limit_high = 0.0;  ///< mean -+ 1.96 standard deviations.
  bool differs = false;
};

struct PairComparison {
  std::uint64_t a = 0;
  std::uint64_t b = 0;
  std::size_t frames = 0;
  double seconds = 0.0;
  std::array<std::optional<JointDifference>, kJointCount> joints;
};

struct Comparison {
  double lag = 0.0;                      ///< Added to B's times to get A's [s].
  std::optional<double> lag_sigma = {};  ///< None: it was given.
  Eigen::Isometry3d a_from_b = Eigen::Isometry3d::Identity();
  double least = 0.0;  ///< Of the options, for readers of the estimates.
  double least_turn = 0.0;
  Estimate yaw;                    ///< Of B's bodies against A's before the transform [rad].
  std::array<Estimate, 3> offset;  ///< A's trunk minus B's before the transform [m].
  std::vector<PairComparison> pairs;
  std::vector<std::uint64_t> only_a;  ///< Nobody in B is where they are.
  std::vector<std::uint64_t> only_b;
  std::vector<double> times;             ///< Of the first pair, by A's clock [s] ...
  std::vector<double> distances;         ///< ... and its mean distance of joints [m].
  std::vector<std::string> differences;  ///< In words; empty: not different.
};

/// Errors: NotFound, nobody in one of the two, or no time in common; Conflict, they do not show one
/// motion; InvalidArgument, a track that is not in order of time.
[[nodiscard]] Result<Comparison> compare(const People& a, const People& b,
                                         const CompareOptions& options = {});

}  // namespace chorus::comparison

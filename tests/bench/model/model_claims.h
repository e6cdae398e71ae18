// Statistics of real Kinect v2 logs: intervals that the simulated sensor is compared with.
#pragma once

#include <limits>
#include <span>

#include "tests/judge/log_statistics.h"

namespace chorus::bench {

/// A published or measured interval; our value may lie outside it by a tolerance, but never beyond
/// the limit.
struct Range {
  double least;
  double most;
  double limit = std::numeric_limits<double>::infinity();
};
inline constexpr double kTolerance = 0.3;

struct Claim {
  const char* case_name;
  const char* metric;
  const char* unit;
  Range range;                    ///< From real logs or publications.
  double tolerance = kTolerance;  ///< Tolerance at its ends.
  bool needs_long = false;        ///< Not tested in the minute of a quick run.
};

/// A statistic of a log: of one joint, or of the bone that ends in it.
struct LogClaim {
  Claim claim;
  double (*of)(const LogStatistics&);
};

/// Claims from the statistics of real logs: two of walking people and one of a gesturing person.
/// They apply to one_sensor_scene(), in which one person walks.
[[nodiscard]] std::span<const LogClaim> walking_claims();
/// Claims from another log, of a person at 2 m with one side turned away from the sensor.  They
/// apply to turned_scene().
[[nodiscard]] std::span<const LogClaim> turned_claims();

}  // namespace chorus::bench

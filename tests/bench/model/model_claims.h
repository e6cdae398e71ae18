// What real Kinect v2 logs are known by: intervals that the simulated sensor is held against.
#pragma once

#include <limits>
#include <span>

#include "tests/judge/log_statistics.h"

namespace chorus::bench {

/// A published or measured interval; ours passes within a tolerance of its ends, never beyond the
/// limit.
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
  Range range;                    ///< Real or published.
  double tolerance = kTolerance;  ///< Of its ends.
  bool needs_long = false;        ///< Not for the minute of a quick run.
};

/// A statistic of a log: of a joint, or of the bone that ends in it.
struct LogClaim {
  Claim claim;
  double (*of)(const LogStatistics&);
};

/// Of two logs of walking people and one of a gesturing person (statistics only); of somebody who
/// walks before one sensor.
[[nodiscard]] std::span<const LogClaim> walking_claims();
/// Of a third log, 2 m away, one side turned away from the sensor; of turned_scene().
[[nodiscard]] std::span<const LogClaim> turned_claims();

}  // namespace chorus::bench

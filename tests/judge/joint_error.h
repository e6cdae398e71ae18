// Mean joint errors against the truth, and how much was seen.
#pragma once

#include "fusion-server/flow.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

struct JointError {
  double sum = 0.0;        ///< [m]
  std::size_t joints = 0;  ///< Seen.
  std::size_t asked = 0;   ///< All joints of all instants.

  [[nodiscard]] double mean() const;  ///< NaN when nothing was seen.
  [[nodiscard]] double coverage() const;
};

void compare(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& exact,
             JointError& error);

/// Of fused bodies; an instant without a body counts as all joints unseen, one with several as its
/// first.
[[nodiscard]] JointError fused_error(const Workshop& workshop,
                                     const std::vector<Snapshot>& snapshots,
                                     const SensorId& master);

/// Of one sensor's raw frames put into the world by these extrinsics; the truth is that of the true
/// exposure.
[[nodiscard]] JointError raw_error(const Workshop& workshop, std::size_t sensor,
                                   const Registration& registration);

}  // namespace chorus::bench

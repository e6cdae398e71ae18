// Mean joint errors against the truth, and the fraction of joints seen.
#pragma once

#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

struct JointError {
  double sum = 0.0;        ///< [m]
  std::size_t joints = 0;  ///< Number of joints seen.
  std::size_t asked = 0;   ///< All joints of all instants.

  [[nodiscard]] double mean() const;  ///< NaN when nothing was seen.
  [[nodiscard]] double coverage() const;
};

void compare(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& exact,
             JointError& error);

/// Error of fused bodies; an instant without a body counts as all joints unseen; if there are
/// several bodies, the first one counts.
[[nodiscard]] JointError fused_error(const Workshop& workshop,
                                     const std::vector<Snapshot>& snapshots,
                                     const SensorId& master);

/// Error of one sensor's raw frames, moved into the world by these extrinsics; the truth is taken
/// at the true exposure.
[[nodiscard]] JointError raw_error(const Workshop& workshop, std::size_t sensor,
                                   const Registration& registration);

}  // namespace chorus::bench

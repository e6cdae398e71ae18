// A suit made from true motion: its root is taken away and every bone errs slowly.  It stands in
// for a real suit beside cameras, because no published take has both.
#pragma once

#include <cstdint>
#include <vector>

#include "common/body/skeleton.h"
#include "common/suit/suit_pose.h"

namespace chorus::bench {

struct SuitErrors {
  double bone = 0.0524;  ///< Angle by which a bone errs, root mean square [rad]: 3 degrees.
  double memory = 4.0;   ///< How long it errs alike [s].
  double size = 1.0;     ///< Of the suit's person, relative to the true one.
  double heading = 0.0;  ///< By which the suit's world is turned [rad].
  std::uint64_t seed = 1;
};

/// `truth` has one body per instant at this rate.  SpineBase, hips, knees, ankles, shoulders,
/// elbows and wrists are made, the rest where the truth has it.
[[nodiscard]] suit::SuitTake suit_of(const std::vector<Skeleton<WorldSpace>>& truth, double rate_hz,
                                     const SuitErrors& errors);

}  // namespace chorus::bench

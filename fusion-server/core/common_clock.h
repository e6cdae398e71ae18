// Which clock the offsets of a walk refer to, where no host says what time it is.
#pragma once

#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// Frames that seem older than this are taken for those of a clock that is behind.
inline constexpr Duration kOldestFrames = std::chrono::milliseconds(100);

/// Moves all offsets together, so that the youngest frames of the walk are neither from the future
/// nor older than kOldestFrames by our clock.  A walk tells clocks only relative to one another,
/// and refers them to the first sensor's; one that is behind would make all frames late for the
/// live output.  Nothing is moved if some host answers with its time, or if the ages are not known.
void keep_near_ours(Registration& registration);

}  // namespace chorus::core

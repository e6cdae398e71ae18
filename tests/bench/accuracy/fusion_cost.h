// The cost of fusing many sensors and many people.
#pragma once

#include "common/base/result.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// The rows `cost-10x6` and `scale-64x2`.
///
/// fuse_p99_ms: one instant from the sensors' frames to the snapshot (alignment, facing,
/// association, sides, fusion) on one thread of this process. output_hz: the output rate of a real
/// fusion server that polls as many sensors, with as many people, over HTTP; left out in quick
/// runs.
[[nodiscard]] Result<void> measure_cost(Report& report);

}  // namespace chorus::bench

// The cost of fusing many sensors and many people.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// The rows `cost-10x6` and `scale-64x2`.
///
/// fuse_p99_ms: processor time of one instant from the sensors' frames to the snapshot (alignment,
/// facing, association, sides, fusion). output_hz, fusion_cores: the output rate of a real fusion
/// server that polls as many sensors, with as many people, over HTTP, and what it uses of the
/// processor; left out in quick runs.  With --only, that case alone.
[[nodiscard]] Result<void> measure_cost(Report& report);
[[nodiscard]] std::vector<std::string> cost_cases();

}  // namespace chorus::bench

// The cases of `chorus-bench positioner`.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Eight real cameras with Vicon truth, each alone, and all pairs of them.
[[nodiscard]] Result<void> eight_views_alone(Report& report);
[[nodiscard]] Result<void> eight_views_pairs(Report& report);

}  // namespace chorus::bench

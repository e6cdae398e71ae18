// The cases of `chorus-bench report`.
#pragma once

#include "common/base/result.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Hidden joints, jumps and changes of ids that are written into true bodies, as the report counts
/// them: equal.
[[nodiscard]] Result<void> report_counts(Report& report);

/// Jitter, variation of bones and stated errors of fused bodies, beside what the truth says of
/// them.
[[nodiscard]] Result<void> report_noise(Report& report);

/// Faults that are planted into simulated recordings, and recordings without any: what the verdict
/// names.
[[nodiscard]] Result<void> report_faults(Report& report);

/// Two fusions of one motion: identical ones, moved and turned ones, later ones.
[[nodiscard]] Result<void> compared_pairs(Report& report);

/// How long `chorus report` takes for an hour of six sensors.
[[nodiscard]] Result<void> report_hour(Report& report);

}  // namespace chorus::bench

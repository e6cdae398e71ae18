// The cases of `chorus-bench positioner`.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Eight real cameras with Vicon truth, each alone, and all pairs of them.
[[nodiscard]] Result<void> eight_views_alone(Report& report);
[[nodiscard]] Result<void> eight_views_pairs(Report& report);

/// Rendered scenes; each with all methods on the same frames.
[[nodiscard]] Result<void> rendered_walk(Report& report);
[[nodiscard]] Result<void> rendered_slide(Report& report);
[[nodiscard]] Result<void> rendered_occlusion(Report& report);
[[nodiscard]] Result<void> rendered_light(Report& report);
[[nodiscard]] Result<void> rendered_two_cameras(Report& report);

/// Four real cameras from their pixels, each alone; needs the runner.
[[nodiscard]] Result<void> four_views_pixels(Report& report);

}  // namespace chorus::bench

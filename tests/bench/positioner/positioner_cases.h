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

/// What a body that is exactly right would gain over capsules.
[[nodiscard]] Result<void> shape_gain(Report& report);

/// Time of a picture, in a region of interest and whole.
[[nodiscard]] Result<void> sight_speed(Report& report);

/// People in PETS 2009 S2.L1, 20 to 30 m away, with a template gait; CHORUS_PETS names its folder.
[[nodiscard]] Result<void> pets_walkers(Report& report);

/// Four real cameras from their pixels, each alone; needs the runner.
[[nodiscard]] Result<void> four_views_pixels(Report& report);

}  // namespace chorus::bench

// Real recordings that may not travel with the project, each with rows of its own.
#pragma once

#include <filesystem>

#include "common/base/result.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Kinect v2 beside optical targets: raw, and the same frames through the pipeline of one sensor.
[[nodiscard]] Result<void> compare_with_keraal(Report& report, const std::filesystem::path& folder);

/// Three cameras of one take without clocks: chains of yaws, copied cameras, what passes for
/// registered.
[[nodiscard]] Result<void> close_nw_ucla_chains(Report& report,
                                                const std::filesystem::path& folder);

/// Two views of one pose.
[[nodiscard]] Result<void> refuse_ntu_poses(Report& report, const std::filesystem::path& folder);

/// Capture times.
[[nodiscard]] Result<void> time_labanotation(Report& report, const std::filesystem::path& folder);

/// Left and right through the pipeline, one sensor each.
[[nodiscard]] Result<void> side_labanotation(Report& report, const std::filesystem::path& folder);
[[nodiscard]] Result<void> side_keraal(Report& report, const std::filesystem::path& folder);
[[nodiscard]] Result<void> side_ntu(Report& report, const std::filesystem::path& folder);
[[nodiscard]] Result<void> side_nw_ucla(Report& report, const std::filesystem::path& folder);

}  // namespace chorus::bench

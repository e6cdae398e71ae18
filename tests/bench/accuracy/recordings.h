// Real recordings that may not be distributed with the project; each has rows of its own.
#pragma once

#include <filesystem>

#include "common/base/result.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Kinect v2 compared with optical targets: raw, and the same frames fused by the pipeline.
[[nodiscard]] Result<void> compare_with_keraal(Report& report, const std::filesystem::path& folder);

/// Three cameras of one take without clocks: reports how well the yaws along chains close, whether
/// copied camera files are refused, and how many pairs are accepted.
[[nodiscard]] Result<void> close_nw_ucla_chains(Report& report,
                                                const std::filesystem::path& folder);

/// Checks that two views of a single pose are not registered.
[[nodiscard]] Result<void> refuse_ntu_poses(Report& report, const std::filesystem::path& folder);

/// Compares the times between frames with those of profile A.
[[nodiscard]] Result<void> time_labanotation(Report& report, const std::filesystem::path& folder);

/// Reports how often left and right are correct after the pipeline; each recording is fused as a
/// single sensor.
[[nodiscard]] Result<void> side_labanotation(Report& report, const std::filesystem::path& folder);
[[nodiscard]] Result<void> side_keraal(Report& report, const std::filesystem::path& folder);
[[nodiscard]] Result<void> side_ntu(Report& report, const std::filesystem::path& folder);
[[nodiscard]] Result<void> side_nw_ucla(Report& report, const std::filesystem::path& folder);
/// Reports how often toes tell left and right, and correctly, in single frames of single sensors.
[[nodiscard]] Result<void> toes_nw_ucla(Report& report, const std::filesystem::path& folder);

}  // namespace chorus::bench

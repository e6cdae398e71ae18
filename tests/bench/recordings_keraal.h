// KERAAL: a Kinect v2 beside optical targets on the same person.
#pragma once

#include <filesystem>

#include "tests/bench/report.h"

namespace chorus::bench {

/// How far the Kinect's joints are from the targets, raw and through the pipeline of one sensor.
[[nodiscard]] Result<void> compare_with_keraal(Report& report, const std::filesystem::path& folder);

}  // namespace chorus::bench

// The cases of `chorus-bench inertial`, one function each.
#pragma once

#include <filesystem>
#include <string_view>

#include "common/base/result.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

struct InertialCase {
  std::string_view name;
  Result<void> (*run)(Report&);
};

/// Orientation filters on BROAD: $CHORUS_BROAD, or the two trials of ../shared/data.
[[nodiscard]] Result<void> run_filter(Report& report);

/// Calibration of simulated pairs, with gross errors of the tracker.
[[nodiscard]] Result<void> run_calibrate(Report& report);

/// Calibration from windows of real takes, judged on their rest.
[[nodiscard]] Result<void> run_calibrate_real(Report& report);

/// Shifts between sensors and cameras of real takes.
[[nodiscard]] Result<void> run_time_real(Report& report);

/// What calibrated sensors leave on real limbs.
[[nodiscard]] Result<void> run_residual_real(Report& report);

/// Errors injected into a simulated tracker, found by a simulated suit; and by other quantities.
[[nodiscard]] Result<void> run_detect(Report& report);

/// The paper's experiment, simulated: 24 takes, five sensors, two synthetic annotators.
[[nodiscard]] Result<void> run_paper(Report& report);

/// A real Kinect against optical targets: $CHORUS_SHARED/data/keraal_kinect2_optical.
[[nodiscard]] Result<void> run_keraal(Report& report);

/// Errors injected into real takes, and found.
[[nodiscard]] Result<void> run_detect_real(Report& report);

/// Limbs that no camera shows for a second, with sensors and without.
[[nodiscard]] Result<void> run_fuse_hidden(Report& report);

/// Limbs that two, four and eight cameras show, and a sensor that slips.
[[nodiscard]] Result<void> run_fuse_seen(Report& report);

/// Headings that drift, followed from bones that cameras see.
[[nodiscard]] Result<void> run_heading(Report& report);

/// Which of three people wears the suit.
[[nodiscard]] Result<void> run_suit_of_whom(Report& report);

/// What following thirteen sensors costs the fusion server.
[[nodiscard]] Result<void> run_worn_cost(Report& report);

/// Sides and identities with what worn sensors say, and without.
[[nodiscard]] Result<void> run_witness(Report& report);

/// The folder of recordings from outside the project: $CHORUS_SHARED/data or ../shared/data.
[[nodiscard]] std::filesystem::path shared_recordings();

}  // namespace chorus::bench

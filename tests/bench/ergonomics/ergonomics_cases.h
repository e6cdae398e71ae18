// The cases of chorus-bench ergonomics.
#pragma once

#include <random>

#include "common/body/skeleton.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Every cell against the second transcription and the public look-ups; mutated cells are noticed.
[[nodiscard]] Result<void> posture_tables(Report& report);
/// Symmetry, invariance, monotonicity and limits, on drawn bodies.
[[nodiscard]] Result<void> posture_laws(Report& report);
/// Eight real cameras against Vicon (tests/bench/camera/totalcapture_views.py makes the folders).
[[nodiscard]] Result<void> posture_real_vicon(Report& report);
/// A Kinect v2 against Vicon.
[[nodiscard]] Result<void> posture_uiprmd(Report& report);
/// Six simulated sensors around somebody at assembly work, with a car and a pillar.
[[nodiscard]] Result<void> posture_simulated(Report& report);
/// Six people, four methods, with doubt.
[[nodiscard]] Result<void> posture_cost(Report& report);

/// A box in both hands of somebody at assembly work.
[[nodiscard]] Result<void> held_box(Report& report);

/// A person in the middle whose joints were moved at random, the limbs far.
[[nodiscard]] Skeleton<WorldSpace> drawn_body(std::mt19937_64& random);

}  // namespace chorus::bench

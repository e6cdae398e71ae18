// The cases of chorus-bench camera.  All run from the top of the repository.
#pragma once

#include <string>
#include <vector>

#include "common/importers/formats.h"
#include "fusion-server/flow.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Where four cameras really stood, what they saw, and the triangulation of that.
inline constexpr const char* kFourViews = "tests/data/pose2sim_mediapipe";
inline constexpr const char* kFourVideos = "tests/data/pose2sim_videos/four";
inline constexpr double kTruthHz = 60.0;

/// The runner that comes with Chorus.
[[nodiscard]] std::vector<std::string> runner_of(const std::string& model);

[[nodiscard]] Registration published_places(const importers::ImportedSet& set);

/// Joints that were answered, beside the published ones.
struct Agreement {
  std::vector<double> errors;  ///< [m]
  std::vector<double> limbs;   ///< The same of shoulders, elbows, wrists, hips, knees and ankles.
  double asked = 0.0;          ///< Published joints at all instants asked about.

  void add(const Skeleton<WorldSpace>& fused, const Skeleton<WorldSpace>& published);
  void missed(const Skeleton<WorldSpace>& published);  ///< Nobody was there.
  void report(Report& report, const std::string& name) const;
};

/// Bundled landmarks, and every picture of the bundled videos: offline, so that it does not matter
/// how fast this computer is.
[[nodiscard]] Result<void> four_views(Report& report);
/// The same videos through real processes.
[[nodiscard]] Result<void> live_views(Report& report);
/// Pictures a second on one core.
[[nodiscard]] Result<void> runner_speed(Report& report);
/// Five simulated cameras and the scenes of `persons`.
[[nodiscard]] Result<void> simulated_people(Report& report);
/// Lenses from rendered pictures of a board.
[[nodiscard]] Result<void> lens_calibration(Report& report);

}  // namespace chorus::bench

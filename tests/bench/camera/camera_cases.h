// The cases of chorus-bench camera.  All run from the top of the repository.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/importers/formats.h"
#include "fusion-server/flow/registration.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Landmarks of four cameras, their true places and the published triangulation.
inline constexpr const char* kFourViews = "tests/data/pose2sim_mediapipe";
inline constexpr const char* kFourVideos = "tests/data/pose2sim_videos/four";
inline constexpr double kTruthHz = 60.0;

/// The command line of the runner that comes with Chorus.
[[nodiscard]] std::vector<std::string> runner_of(const std::string& model);

[[nodiscard]] Registration published_places(const importers::ImportedSet& set);

/// How well fused joints agree with the published ones.
struct Agreement {
  std::vector<double> errors;  ///< [m]
  std::vector<double> limbs;   ///< Errors of shoulders, elbows, wrists, hips, knees and ankles [m].
  double asked = 0.0;          ///< Number of published joints at all instants asked about.

  void add(const Skeleton<WorldSpace>& fused, const Skeleton<WorldSpace>& published);
  void missed(const Skeleton<WorldSpace>& published);  ///< Counts an instant without a body.
  void report(Report& report, const std::string& name) const;
};

/// Fuses the bundled landmarks, and every picture of the bundled videos, offline, so that the speed
/// of this computer does not matter.
[[nodiscard]] Result<void> four_views(Report& report);
/// Fuses takes of eight real cameras and compares them with Vicon, where that data is at hand.
[[nodiscard]] Result<void> eight_views(Report& report);
/// The folders of those takes; none where that data is not at hand.
[[nodiscard]] std::vector<std::filesystem::path> eight_view_takes();
/// Measures where people are put whom one camera of four alone sees for two seconds.
[[nodiscard]] Result<void> one_left(Report& report);
/// Registers cameras that send rays alone: simulated, and real ones where that data is at hand.
[[nodiscard]] Result<void> rays_alone(Report& report);
/// Fuses the bundled videos with real processes.
[[nodiscard]] Result<void> live_views(Report& report);
/// Measures how many pictures a second a runner processes on one core.
[[nodiscard]] Result<void> runner_speed(Report& report);
/// Measures identities with five simulated cameras in the scenes of `persons`.
[[nodiscard]] Result<void> simulated_people(Report& report);
/// Measures the accuracy of lenses from rendered pictures of a board.
[[nodiscard]] Result<void> lens_calibration(Report& report);

}  // namespace chorus::bench

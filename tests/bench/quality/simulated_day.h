// A day in the simulated workshop as a recording holds it: a walk registers the sensors, then
// people work; what the sensors said and what was fused from it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/quality/quality_report.h"
#include "common/resource/frame_resource.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

using SensorTracks = std::vector<registration::WalkTrack>;
using FusedFrames = std::vector<resource::FrameResource>;

struct DaySetting {
  Setting work;  ///< Profile, seed, people, things, length of the recording after the walk.
  /// Changes what the sensors say after the walk; none: nothing.
  std::function<void(SensorTracks&)> in_views = {};
  /// Changes what was published.
  std::function<void(FusedFrames&)> in_fused = {};
  std::function<void(Registration&)> in_registration = {};
  /// Draws the sensors' errors anew, with their parameters and biases as they are: the same room
  /// records the same motion once more.
  std::optional<std::uint64_t> errors = {};
  double rate_hz = 30.0;  ///< Of the output.
};

struct Day {
  Workshop work;  ///< With the truth, and the tracks without what was planted.
  Registration registration;
  SensorTracks tracks;  ///< As recorded.
  FusedFrames fused;
};

/// Draws a walk of one person (30 s), registers, draws the work, plants, and fuses.  The same
/// setting gives the same day.
[[nodiscard]] Result<Day> simulated_day(const DaySetting& setting);

/// What `chorus report` finds of it, from the same code.
[[nodiscard]] quality::RecordingQuality judged(const Day& day);

/// A person's true body in the world of the day's registration, apart from that one's errors.
[[nodiscard]] Skeleton<WorldSpace> true_body(const Day& day, std::size_t person, Timestamp at);

}  // namespace chorus::bench

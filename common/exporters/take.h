// What is exported: fused skeletons on a uniform grid of instants, one track per person.
//
// Fused frames may skip instants, and people come and go; motion files have one rate and no holes.
// So the samples are put on the grid start + i / rate: a sample within a microsecond of a grid
// instant is kept unchanged; other instants are interpolated (positions linearly) between
// neighbours that are at most `max_gap` apart.  Everything else is a gap: no joint is tracked
// there, and each format says "missing" in its own way.  World space, metres, +y up.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/base/strong_id.h"
#include "common/body/skeleton.h"
#include "common/time/timestamp.h"

namespace chorus::exporters {

/// One person at one instant.
struct FusedSample {
  Timestamp instant;
  PersonId person;
  Skeleton<WorldSpace> skeleton;
  /// Mean per-axis variance [m^2] of each joint; NaN: not known.
  std::array<double, kJointCount> variance = unknown_variance();

  [[nodiscard]] static constexpr std::array<double, kJointCount> unknown_variance() {
    std::array<double, kJointCount> all{};
    for (double& each : all) each = std::numeric_limits<double>::quiet_NaN();
    return all;
  }
};

struct Pose {
  Skeleton<WorldSpace> skeleton;
  std::array<double, kJointCount> variance = FusedSample::unknown_variance();
};

struct PersonTrack {
  PersonId person;
  std::vector<Pose> poses;  ///< As many as Take::frames.
};

struct Take {
  Timestamp start;  ///< The instant of the earliest sample of all persons.
  double rate_hz = 0.0;
  std::size_t frames = 0;
  std::vector<PersonTrack> persons;  ///< In order of their ids.
  /// When each frame was captured: that of a sample that was kept unchanged, else the grid instant.
  /// Empty: the grid instants.
  std::vector<Timestamp> instants = {};
};

struct TakeOptions {
  /// 0: derived from the median step, so that the last sample lies on the grid.
  double rate_hz = 0.0;
  Duration max_gap = std::chrono::milliseconds(200);
  std::optional<PersonId> person = {};  ///< Export only this person.
};

/// Limit for the poses of all persons together; one pose takes 2.6 kB.
inline constexpr std::size_t kMaxPoses = 500'000;

/// Puts the samples, which may come in any order, on the grid.  Refuses: no samples; a rate below 0
/// or above 1000 Hz; an unknown person (the error names the known ones); two samples of a person at
/// one instant; more than kMaxPoses.
[[nodiscard]] Result<Take> make_take(std::vector<FusedSample> samples,
                                     const TakeOptions& options = {});

/// What comes before the names of a person's markers and columns: "P3" and the separator; of a take
/// of one person nothing.
[[nodiscard]] std::string prefix_of(const Take& take, const PersonTrack& track,
                                    std::string_view separator = "_");

/// The instant of a frame.
[[nodiscard]] Timestamp instant_of(const Take& take, std::size_t frame);

}  // namespace chorus::exporters

// A recording of one person, scored: time in each level with an interval, peaks, the worst moments,
// and the share of time without a score and why.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/ergonomics/live.h"
#include "common/ergonomics/task.h"

namespace chorus::ergonomics {

/// The share of the scored time in a level.
struct ZoneTime {
  double share = 0.0;  ///< With the highest code of each unknown input.
  double least = 0.0;  ///< Of the time in which the level is this one, whatever unknown inputs are.
  double most = 0.0;   ///< Of the time in which it may be this one.
  double low = 0.0;    ///< The 90 % interval: from that of `least` to that of `most`.
  double high = 0.0;
};

struct Moment {
  double at = 0.0;        ///< [s] from the beginning.
  std::size_t index = 0;  ///< Of the instant.
  ScoreRange score;
  ScoreSet set;  ///< At 90 %.
};

struct MethodSummary {
  const Method* method = nullptr;
  double scored = 0.0;                      ///< Share of the time.
  std::array<double, kReasons> unscored{};  ///< Shares of the time, by Unscored.
  std::vector<ZoneTime> levels;             ///< In the order of Method::levels.
  int p50 = 0;                              ///< Of the higher ends of the ranges.
  int p90 = 0;
  std::array<int, 2> side_p90{};  ///< Left, right; of sided methods.
  std::vector<Moment> worst;      ///< At most three, two seconds apart at least.
  double certain = 0.0;           ///< Share of the scored time in which one score has 90 %.
};

/// Excursions of a measure beyond a limit, as EN 1005-4 counts movements.
struct MovementCount {
  std::string_view measure;
  double limit = 0.0;  ///< [rad]
  double per_minute = 0.0;
};

struct ScoredInstant {
  double at = 0.0;
  std::vector<DoubtfulScore> scores;  ///< In the order of the methods.
};

struct ScoredPerson {
  std::vector<ScoredInstant> instants;
  std::vector<Observation> observations;
  std::vector<MethodSummary> methods;
  /// Summaries of the task's phases, in its order.
  std::vector<std::vector<MethodSummary>> phases;
  std::vector<MovementCount> movements;
  double seconds = 0.0;
  std::optional<double> cycles = {};  ///< If the task states the length of one.
  bool has_stance = false;
  std::size_t doubtless = 0;  ///< The most joints without a stated doubt at an instant.
};

/// `bodies` in the order of time; `start` is the recording's first instant, `stance` the person's
/// own (none: angles are absolute).
struct ScoringInput {
  const std::vector<BodyAt>& bodies;
  const std::vector<const Method*>& methods;
  const Task& task;
  Timestamp start;
  std::optional<posture::Neutral> stance = {};
};
[[nodiscard]] ScoredPerson score_person(const ScoringInput& input);

/// Sums up instants [first, last) for one method (by its place in ScoredInstant::scores).
struct Slice {
  std::size_t first = 0;
  std::size_t last = 0;
};
[[nodiscard]] MethodSummary summary_of(const ScoredPerson& person, const ScoringInput& input,
                                       std::size_t method, const Slice& slice);

}  // namespace chorus::ergonomics

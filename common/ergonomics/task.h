// The task file: what is asked about a recording (loads, grips), for the whole of it or for phases.
//
//   {"title": "Battery", "cycleSeconds": 60, "stance": {"fromSeconds": 0, "toSeconds": 2},
//    "loadKg": 0, "shock": false, ...,
//    "phases": [{"name": "lift", "fromSeconds": 4, "toSeconds": 9, "loadKg": 12}],
//    "lifts": [{"fromSeconds": 4, "toSeconds": 6, "loadKg": 12, "perMinute": 0.5, "hours": 1,
//    "coupling": "fair"}], "eawsPoints": {"secondsPerMinute": [3, 4.5], "points": {"standing":
//    [0.7, 1]}}}
//
// Seconds count from the first frame of the recording.  Instead of them, phases, lifts and the
// stance may name marks that were set while it ran: {"name": "lift", "fromMark": "takes it",
// "toMark": "puts it down"}, once for each mark of that name; without "toMark" until the next mark
// of any name, or the recording's end.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/ergonomics/asked.h"

namespace chorus::ergonomics {

struct Span {
  double from = 0.0;  ///< [s]
  double to = 0.0;    ///< [s], not included

  [[nodiscard]] bool holds(double at) const { return at >= from && at < to; }
};

/// An instant that somebody named while the recording ran.
struct NamedInstant {
  double at = 0.0;  ///< [s]
  std::string name;
};

/// What the keys fromMark and toMark mean.
struct Marks {
  std::vector<NamedInstant> all;  ///< In the order of time.
  double end = 0.0;               ///< Of the recording [s].
};

struct Phase {
  std::string name;
  Span span;
  Asked asked;
};

struct TaskLift {
  Span span;  ///< From taking the load up to putting it down.
  double load_kg = 0.0;
  double per_minute = 0.2;
  double hours = 1.0;
  Coupling coupling = Coupling::Good;
};

/// The points of the user's own sheet: a row for each class, a column for each duration.
struct ClassPoints {
  std::vector<double> seconds_per_minute;
  std::map<std::string, std::vector<double>> points;
};

struct Task {
  std::string title;
  std::optional<double> cycle = {};  ///< [s]
  std::optional<Span> stance = {};   ///< Where the person stands upright on request.
  Asked asked;                       ///< Outside phases, and inside for what they leave open.
  std::vector<Phase> phases;         ///< In the order of time, without overlap.
  std::vector<TaskLift> lifts;
  std::optional<ClassPoints> points = {};

  [[nodiscard]] Asked asked_at(double at) const;
  /// The phase's index; none between phases.
  [[nodiscard]] std::optional<std::size_t> phase_at(double at) const;
};

/// InvalidArgument names the key: unknown ones (with the nearest known), phases that overlap or end
/// before they begin, loads that look like newtons, marks that were not set.
[[nodiscard]] Result<Task> read_task(std::string_view text, const std::string& file,
                                     const Marks& marks = {});

/// Refuses phases, lifts and stances that reach beyond a recording of `seconds`.
[[nodiscard]] Result<void> fits(const Task& task, double seconds, const std::string& file);

}  // namespace chorus::ergonomics

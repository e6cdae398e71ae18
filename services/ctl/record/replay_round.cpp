#include "services/ctl/record/replay_round.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace chorus::ctl {
namespace {

using Stays = std::vector<record::SensorStay>;

// Pause between rounds: one frame, so that it looks like any other step.
constexpr Duration kBetweenRounds = std::chrono::milliseconds(33);

/// The first and last beginnings and ends of all streams.
struct Spans {
  Timestamp first_begin = Timestamp::max();
  Timestamp last_begin = Timestamp::min();
  Timestamp first_end = Timestamp::max();
  Timestamp last_end = Timestamp::min();
};

Spans spans_of(const Stays& stays) {
  Spans spans;
  for (const auto& stay : stays) {
    spans.first_begin = std::min(spans.first_begin, stay.first);
    spans.last_begin = std::max(spans.last_begin, stay.first);
    spans.first_end = std::min(spans.first_end, stay.last);
    spans.last_end = std::max(spans.last_end, stay.last);
  }
  return spans;
}

std::string noted(const record::SensorStay& stay, const char* key) {
  const auto note = stay.about.notes.find(key);
  return note == stay.about.notes.end() ? std::string{} : note->second;
}

/// True when all streams were imported together, which their equal notes show.
bool one_import(const Stays& stays) {
  return std::ranges::all_of(stays, [&](const auto& stay) {
    return std::ranges::all_of(
               std::array{"set_origin", "set_origin_ns", "set_period_ns"},
               [&](const char* key) { return noted(stay, key) == noted(stays.front(), key); }) &&
           !(noted(stay, "set_origin") + noted(stay, "set_origin_ns")).empty();
  });
}

/// Our own recordings are in UTC; an imported one states whether it is.
bool knows_utc(const record::SensorStay& stay) {
  const std::string time = noted(stay, "time");
  return time.empty() || time.starts_with("UTC");
}

std::vector<std::string> without_utc(const Stays& stays) {
  std::vector<std::string> names;
  for (const auto& stay : stays) {
    if (!knows_utc(stay)) names.push_back(stay.about.sensor.str());
  }
  return names;
}

}  // namespace

RoundPlan plan_round(const Stays& stays) {
  const bool cell = std::ranges::any_of(stays, &record::SensorStay::cell);
  if (stays.empty() || (stays.size() < 2 && !cell) || one_import(stays)) return {};
  if (const auto names = without_utc(stays); !names.empty()) {
    return {{},
            fmt::format("nothing says how the clocks of {} and the others belong together; each "
                        "starts at its own beginning (import files of one take in one call)",
                        fmt::join(names, ", "))};
  }
  const Spans spans = spans_of(stays);
  if (!cell && spans.last_begin > spans.first_end)
    return {{}, "these recordings are of different times; each starts at its own beginning"};
  return {Round{spans.first_begin, spans.last_end - spans.first_begin + kBetweenRounds}, {}};
}

}  // namespace chorus::ctl

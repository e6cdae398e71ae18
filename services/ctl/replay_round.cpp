#include "services/ctl/replay_round.h"

#include <algorithm>

namespace chorus::ctl {
namespace {

constexpr Duration kBetweenRounds = std::chrono::milliseconds(33);  // one frame, as between others

/// Of the streams that hold frames.
struct Spans {
  std::size_t streams = 0;
  std::size_t noted = 0;  ///< Of them, those that say when their set begins.
  Timestamp first_begin = Timestamp::max();
  Timestamp last_begin = Timestamp::min();
  Timestamp first_end = Timestamp::max();
  Timestamp last_end = Timestamp::min();
};

Spans spans_of(const record::Session& session) {
  Spans spans;
  for (const auto& sensor : session.sensors) {
    if (sensor.frames.empty()) continue;
    ++spans.streams;
    if (sensor.notes.contains("set_origin") || sensor.notes.contains("set_origin_ns"))
      ++spans.noted;
    spans.first_begin = std::min(spans.first_begin, sensor.frames.front().captured);
    spans.last_begin = std::max(spans.last_begin, sensor.frames.front().captured);
    spans.first_end = std::min(spans.first_end, sensor.frames.back().captured);
    spans.last_end = std::max(spans.last_end, sensor.frames.back().captured);
  }
  return spans;
}

bool apart(const record::Session& session, const Spans& spans) {
  return session.cell.empty() && spans.noted < spans.streams && spans.last_begin > spans.first_end;
}

}  // namespace

std::optional<Round> round_of(const record::Session& session) {
  const Spans spans = spans_of(session);
  const bool alone = spans.streams < 2 && session.cell.empty();
  if (spans.streams == 0 || alone || spans.noted == spans.streams || apart(session, spans))
    return std::nullopt;
  return Round{spans.first_begin, spans.last_end - spans.first_begin + kBetweenRounds};
}

bool of_different_times(const record::Session& session) {
  return apart(session, spans_of(session));
}

}  // namespace chorus::ctl

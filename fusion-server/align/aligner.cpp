#include "fusion-server/align/aligner.h"

#include <algorithm>
#include <cmath>

#include "common/body/interpolate.h"
#include "fusion-server/align/same_body.h"

namespace chorus::align {
namespace {

/// Added to the longest delay seen so far, because a frame may be a little later than all before.
constexpr Duration kGrace = std::chrono::milliseconds(15);
constexpr int kPeriods = 2;  // A gap of this many of a sensor's periods is still interpolated.

/// The frames around an instant; if one was captured at the instant itself, `before` and `after`
/// are that frame.
struct Bracket {
  Basis basis = Basis::Lost;
  const SensorFrame* before = nullptr;
  const SensorFrame* after = nullptr;
};

Bracket bracket(Timestamp instant, Timestamp now, const History& history,
                const AlignConfig& config) {
  const auto& frames = history.frames();
  const bool over = frames.empty() || frames.back().captured < instant;  // True in most calls.
  const auto next =
      over ? frames.end()
           : std::lower_bound(frames.begin(), frames.end(), instant,
                              [](const SensorFrame& f, Timestamp t) { return f.captured < t; });
  const Duration widest = widest_gap(history, config);
  Bracket found;
  if (next != frames.end() && next->captured == instant) {
    return {Basis::Exact, &*next, &*next};
  }
  if (next != frames.begin()) found.before = &*std::prev(next);
  if (next != frames.end()) found.after = &*next;
  if (!found.after) {
    // Gives up a silent sensor early: whatever frame comes later, a gap as wide as this would not
    // be interpolated.
    const bool hopeless = found.before && instant - found.before->captured > widest;
    const Duration wait =
        std::min(config.patience, longest_wait(history).value_or(config.patience));
    found.basis = hopeless || now - instant > wait ? Basis::Lost : Basis::Pending;
  } else if (found.before && found.after->captured - found.before->captured <= widest) {
    found.basis = Basis::Interpolated;
  }
  return found;
}

std::vector<BodyFrame> bodies_between(const Bracket& around, Timestamp instant,
                                      const AlignConfig& config) {
  const Duration gap = around.after->captured - around.before->captured;
  const double s = seconds(instant - around.before->captured) / seconds(gap);
  std::vector<BodyFrame> bodies;
  for (const auto& [earlier, later] : same_bodies(*around.before, *around.after, config.max_speed))
    bodies.push_back({earlier->id, instant, interpolate(earlier->skeleton, later->skeleton, s),
                      between(earlier->hands, later->hands, s)});
  return bodies;
}

}  // namespace

Duration widest_gap(const History& history, const AlignConfig& config) {
  const Duration own = kPeriods * history.period().value_or(Duration{0});
  return std::max(config.max_gap, std::min(own, config.slowest));
}

std::optional<Duration> longest_wait(const History& history) {
  if (!history.habit()) return std::nullopt;
  return history.habit()->longest_wait + kGrace;
}

std::optional<Duration> usual_wait(const History& history) {
  if (!history.habit()) return std::nullopt;
  return history.habit()->usual_wait + kGrace;
}

Basis basis_at(Timestamp instant, Timestamp now, const History& history,
               const AlignConfig& config) {
  return bracket(instant, now, history, config).basis;
}

AlignedSensor at(Timestamp instant, Timestamp now, const SensorId& sensor, const History& history,
                 const AlignConfig& config) {
  const Bracket around = bracket(instant, now, history, config);
  AlignedSensor aligned;
  aligned.sensor = sensor;
  aligned.basis = around.basis;
  if (around.before) aligned.floor = around.before->floor;
  if (around.basis == Basis::Exact) {
    aligned.bodies = around.before->bodies;
    for (BodyFrame& body : aligned.bodies) body.captured = instant;
  } else if (around.basis == Basis::Interpolated) {
    aligned.bodies = bodies_between(around, instant, config);
  }
  return aligned;
}

}  // namespace chorus::align

#include "fusion-server/align/aligner.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::align {
namespace {

constexpr Duration kGrace = std::chrono::milliseconds(15);  ///< Later than ever before, but coming.

/// The frames around an instant; `before` and `after` are the same frame when it is hit exactly.
struct Bracket {
  Basis basis = Basis::Lost;
  const SensorFrame* before = nullptr;
  const SensorFrame* after = nullptr;
};

Bracket bracket(Timestamp instant, Timestamp now, const History& history,
                const AlignConfig& config) {
  const auto& frames = history.frames();
  const auto next =
      std::lower_bound(frames.begin(), frames.end(), instant,
                       [](const SensorFrame& f, Timestamp t) { return f.captured < t; });
  Bracket found;
  if (next != frames.end() && next->captured == instant) {
    return {Basis::Exact, &*next, &*next};
  }
  if (next != frames.begin()) found.before = &*std::prev(next);
  if (next != frames.end()) found.after = &*next;
  if (!found.after) {
    // A silent sensor is given up early: no later frame could close a bracket this wide.
    const bool hopeless = found.before && instant - found.before->captured > config.max_gap;
    const Duration wait = std::min(config.patience, usual_wait(history).value_or(config.patience));
    found.basis = hopeless || now - instant > wait ? Basis::Lost : Basis::Pending;
  } else if (found.before && found.after->captured - found.before->captured <= config.max_gap) {
    found.basis = Basis::Interpolated;
  }
  return found;
}

Joint between(const Joint& a, const Joint& b, double s) {
  if (!a.given() || !b.given() || a.measurement != b.measurement) return {};
  Joint joint;
  joint.measurement = a.measurement;
  joint.position = (1.0 - s) * a.position + s * b.position;
  if (joint.measurement == Measurement::Ray) joint.position.normalize();
  joint.covariance = between(a.covariance, b.covariance, s);
  if (is_unit(a.orientation) && is_unit(b.orientation)) {
    joint.orientation = lerp(a.orientation, b.orientation, s);
  }
  joint.state = std::min(a.state, b.state);
  return joint;
}

const BodyFrame* body_of(const SensorFrame& frame, BodyId id) {
  for (const BodyFrame& body : frame.bodies) {
    if (body.id == id) return &body;
  }
  return nullptr;
}

std::vector<BodyFrame> bodies_between(const Bracket& around, Timestamp instant) {
  const Duration gap = around.after->captured - around.before->captured;
  const double s = seconds(instant - around.before->captured) / seconds(gap);
  std::vector<BodyFrame> bodies;
  for (const BodyFrame& earlier : around.before->bodies) {
    const BodyFrame* later = body_of(*around.after, earlier.id);
    if (!later) continue;
    bodies.push_back({earlier.id, instant, interpolate(earlier.skeleton, later->skeleton, s)});
  }
  return bodies;
}

}  // namespace

Skeleton<SensorSpace> interpolate(const Skeleton<SensorSpace>& a, const Skeleton<SensorSpace>& b,
                                  double s) {
  const double share = std::isfinite(s) ? std::clamp(s, 0.0, 1.0) : 0.0;
  Skeleton<SensorSpace> body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    body.joints[i] = between(a.joints[i], b.joints[i], share);
  }
  return body;
}

std::optional<Duration> usual_wait(const History& history) {
  if (!history.habit()) return std::nullopt;
  return history.habit()->gap + history.habit()->most_delay + kGrace;
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
    aligned.bodies = bodies_between(around, instant);
  }
  return aligned;
}

}  // namespace chorus::align

#include "fusion-server/core/registration_session.h"

#include <algorithm>

namespace chorus::core {
namespace {

int rank(Verdict verdict) {
  switch (verdict) {
    case Verdict::Good:
      return 2;
    case Verdict::Provisional:
      return 1;
    case Verdict::None:
    case Verdict::Refused:
      return 0;
  }
  return 0;
}

bool covers(const Registration& wider, const Registration& narrower) {
  return std::all_of(narrower.sensors.begin(), narrower.sensors.end(),
                     [&](const auto& entry) { return wider.sensors.contains(entry.first); });
}

}  // namespace

void RegistrationSession::start(Duration target) {
  cancel();
  collecting_ = true;
  target_ = target;
}

void RegistrationSession::cancel() {
  collecting_ = false;
  elapsed_ = Duration{0};
  solved_at_ = Duration{0};
  last_seen_.reset();
  tracks_.clear();
}

void RegistrationSession::add(const SensorFrame& frame) {
  if (!collecting_ || frame.bodies.empty()) return;
  // Our own time of receipt: a sensor whose clock lies must not stretch the session.
  if (last_seen_) {
    const Duration pause = frame.received - *last_seen_;
    if (pause > Duration{0} && pause <= config_.max_pause) elapsed_ += pause;
  }
  last_seen_ = frame.received;
  auto& track = tracks_[frame.sensor];
  if (track.size() >= config_.max_frames) return;
  if (track.empty() || frame.captured > track.back().captured) track.push_back(frame);
}

std::optional<SolveKind> RegistrationSession::due() {
  if (!collecting_) return std::nullopt;
  if (elapsed_ >= target_) {
    collecting_ = false;
    solved_at_ = elapsed_;
    return SolveKind::Final;
  }
  if (elapsed_ < config_.first_solve) return std::nullopt;
  if (solved_at_ > Duration{0} && elapsed_ - solved_at_ < config_.solve_every) return std::nullopt;
  solved_at_ = elapsed_;
  return SolveKind::Provisional;
}

std::vector<registration::WalkTrack> RegistrationSession::walk() const {
  std::vector<registration::WalkTrack> walk;
  walk.reserve(tracks_.size());
  for (const auto& [sensor, frames] : tracks_) walk.push_back({sensor, frames});
  return walk;
}

bool should_adopt(const Registration& current, const Registration& candidate, SolveKind kind) {
  if (rank(candidate.verdict) == 0 || candidate.sensors.empty()) return false;
  if (rank(current.verdict) == 0 || current.sensors.empty()) return true;
  if (!covers(candidate, current)) return false;
  const bool more_sensors = candidate.sensors.size() > current.sensors.size();
  if (rank(candidate.verdict) < rank(current.verdict)) return more_sensors;
  // A provisional solve in the middle of a walk does not push a good one aside; its end may.
  const bool same_session_improves = rank(current.verdict) == rank(Verdict::Provisional);
  return more_sensors || kind == SolveKind::Final || same_session_improves ||
         rank(candidate.verdict) > rank(current.verdict);
}

std::set<SensorId> unplaced(const Registration& current, const std::set<SensorId>& seeing) {
  std::set<SensorId> missing;
  for (const SensorId& sensor : seeing) {
    if (!current.sensors.contains(sensor)) missing.insert(sensor);
  }
  return missing;
}

}  // namespace chorus::core

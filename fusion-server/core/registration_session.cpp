#include "fusion-server/core/registration_session.h"

#include <algorithm>
#include <utility>

namespace chorus::core {
namespace {

constexpr std::size_t kChunk = 64;  // frames; about two seconds
constexpr int kRest = 3;            // the pause after a solve is this many times its duration

}  // namespace

std::vector<registration::WalkTrack> assembled(const SharedWalk& walk) {
  std::vector<registration::WalkTrack> tracks;
  tracks.reserve(walk.size());
  for (const auto& [sensor, chunks] : walk) {
    registration::WalkTrack track{sensor, {}};
    std::size_t frames = 0;
    for (const auto& chunk : chunks) frames += chunk->size();
    track.frames.reserve(frames);
    for (const auto& chunk : chunks)
      track.frames.insert(track.frames.end(), chunk->begin(), chunk->end());
    tracks.push_back(std::move(track));
  }
  return tracks;
}

void RegistrationSession::start(Duration target) {
  cancel();
  coverage_.clear();
  collecting_ = true;
  target_ = target;
}

void RegistrationSession::cancel() {
  collecting_ = false;
  elapsed_ = Duration{0};
  solved_at_ = Duration{0};
  cost_ = Duration{0};
  last_seen_.reset();
  tracks_.clear();
}

void RegistrationSession::seal(Track& track) {
  if (track.open) track.sealed.push_back(std::move(track.open));
  track.open.reset();
}

void RegistrationSession::add(const SensorFrame& frame) {
  if (!collecting_) return;
  coverage_.add(frame);
  if (frame.bodies.empty()) return;
  // Measured by our clock at receipt: a sensor's wrong clock must not stretch the session.
  if (last_seen_) {
    const Duration pause = frame.received - *last_seen_;
    if (pause > Duration{0} && pause <= config_.max_pause) elapsed_ += pause;
  }
  last_seen_ = frame.received;
  Track& track = tracks_[frame.sensor];
  if (track.frames >= config_.max_frames) return;
  if (track.frames > 0 && frame.captured <= track.last) return;
  if (!track.open) {
    track.open = std::make_shared<Chunk>();
    track.open->reserve(kChunk);
  }
  track.open->push_back(frame);
  track.last = frame.captured;
  ++track.frames;
  if (track.open->size() == kChunk) seal(track);
}

std::optional<SolveKind> RegistrationSession::due() {
  if (!collecting_) return std::nullopt;
  if (final_due()) {
    collecting_ = false;
    solved_at_ = elapsed_;
    return SolveKind::Final;
  }
  if (elapsed_ < config_.first_solve) return std::nullopt;
  const Duration rest = std::max(config_.solve_every, kRest * cost_);
  if (solved_at_ > Duration{0} && elapsed_ - solved_at_ < rest) return std::nullopt;
  solved_at_ = elapsed_;
  return SolveKind::Provisional;
}

SharedWalk RegistrationSession::walk() {
  SharedWalk walk;
  walk.reserve(tracks_.size());
  for (auto& [sensor, track] : tracks_) {
    seal(track);
    walk.push_back({sensor, track.sealed});
  }
  if (!collecting_) tracks_.clear();
  return walk;
}

}  // namespace chorus::core

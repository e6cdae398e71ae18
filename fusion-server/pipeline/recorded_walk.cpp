#include "fusion-server/pipeline/recorded_walk.h"

#include <algorithm>
#include <utility>

namespace chorus::pipeline {
namespace {

constexpr std::size_t kMaxWalkers = 60'000;  // This many bodies need 100 MB.
// Frames with several people are used for the floor only, because they show where the feet are.
constexpr std::size_t kMaxSeveral = 10'000;
/// A gap longer than this does not count as time in which a person was seen.
constexpr Duration kNextSight = std::chrono::seconds(1);

}  // namespace

registration::WalkTrack& RecordedWalk::track_of(const SensorId& sensor) {
  const auto at = std::ranges::lower_bound(tracks_, sensor, {}, &registration::WalkTrack::sensor);
  if (at != tracks_.end() && at->sensor == sensor) return *at;
  return *tracks_.insert(at, {sensor, {}});
}

void RecordedWalk::take(SensorFrame frame) {
  auto& frames = track_of(frame.sensor).frames;
  const std::size_t bodies = frame.bodies.size();
  if (bodies == 1) {
    ++bodies_;
    const Timestamp t = frame.captured;
    if (last_alone_ < t && t - kNextSight <= last_alone_) alone_ += t - last_alone_;
    last_alone_ = std::max(last_alone_, t);
  } else if (bodies > 1 && several_ + bodies <= kMaxSeveral) {
    several_ += bodies;
  } else {
    frame.bodies.clear();
    if (!frames.empty() && frames.back().floor == frame.floor) return;
  }
  frames.push_back(std::move(frame));
}

bool RecordedWalk::used_up() const { return bodies_ >= kMaxWalkers; }

void RecordedWalk::go_on() { wanted_ += std::chrono::minutes(2); }

}  // namespace chorus::pipeline

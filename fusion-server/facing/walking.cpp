#include "fusion-server/facing/walking.h"

#include <algorithm>

namespace chorus::facing {
namespace {

// Longest step between two instants to which a single speed is given.
constexpr Duration kMaxStep = std::chrono::milliseconds(300);

}  // namespace

void Walk::follow(const std::vector<SensorView>& views, Timestamp instant, const WalkingCue& cue) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int moved = 0;
  for (const SensorView& view : views) {
    const Joint& middle = view.skeleton[JointId::SpineMid];
    if (!middle.seen()) continue;
    const auto [trunk, fresh] = trunks_.try_emplace(view.sensor, Trunk{instant, middle.position});
    const Duration step = instant - trunk->second.seen;
    if (!fresh && step > Duration{0} && step <= kMaxStep) {
      sum += (middle.position - trunk->second.place) / seconds(step);
      ++moved;
    }
    trunk->second = {instant, middle.position};
  }
  std::erase_if(trunks_, [&](const auto& each) { return instant - each.second.seen > kMaxStep; });
  if (moved == 0) return;
  const double elapsed = std::clamp(seconds(instant - followed_), 0.0, seconds(kMaxStep));
  followed_ = instant;
  sum.y() = 0;
  velocity_ += elapsed / (elapsed + cue.smoothing) * (sum / moved - velocity_);
}

double Walk::log_odds(const Eigen::Vector3d& forward, const WalkingCue& cue) const {
  const double speed = velocity_.norm();
  if (!(speed > cue.from)) return 0.0;
  const double certain = std::min(1.0, (speed - cue.from) / (cue.full - cue.from));
  return cue.log_odds * certain * velocity_.dot(forward) / speed;
}

}  // namespace chorus::facing

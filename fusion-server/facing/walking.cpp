#include "fusion-server/facing/walking.h"

#include <algorithm>
#include <cmath>

namespace chorus::facing {
namespace {

// Longest step between two instants to which a single speed is given.
constexpr Duration kMaxStep = std::chrono::milliseconds(300);
constexpr double kClimbTime = 0.3;  // [s]; a jump is longer, and bridges its own highest point.

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
  velocity_ += elapsed / (elapsed + cue.smoothing) * (sum / moved - velocity_);
  climb_ += elapsed / (elapsed + kClimbTime) * (std::abs(velocity_.y()) - climb_);
}

double Walk::log_odds(const Eigen::Vector3d& forward, const WalkingCue& cue) const {
  const double speed = std::hypot(velocity_.x(), velocity_.z());
  if (!(speed > cue.from)) return 0.0;
  const double certain = std::min(1.0, (speed - cue.from) / (cue.full - cue.from));
  const double level = std::clamp((cue.steep - climb_ / speed) / (cue.steep - cue.level), 0.0, 1.0);
  return cue.log_odds * certain * level * velocity_.dot(forward) / speed;
}

}  // namespace chorus::facing

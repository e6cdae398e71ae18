#include "services/sensor/device/positioner/live_tracker.h"

#include <algorithm>
#include <utility>

namespace chorus::positioner {
namespace {

constexpr Duration kRemembered = std::chrono::seconds(2);

/// The pose between two poses.
suit::SuitInstant between(const suit::SuitInstant& a, const suit::SuitInstant& b, Timestamp at) {
  const Duration span = b.captured - a.captured;
  suit::SuitTake take;
  take.poses = {a.pose, b.pose};
  take.poses[0].time = Duration{0};
  take.poses[1].time = span;
  suit::SuitInstant out = a;
  out.pose = pose_at(take, at - a.captured);
  out.captured = at;
  return out;
}

}  // namespace

LiveTracker::LiveTracker(const positioning::TrackerSettings& settings)
    : settings_(settings), at_picture_(settings), now_(settings) {}

void LiveTracker::forget() {
  at_picture_ = positioning::Tracker(settings_);
  now_ = at_picture_;
  poses_.clear();
  pictured_.reset();
  tracked_.reset();
  pictured_place_.reset();
}

void LiveTracker::advance(positioning::Tracker& tracker, const suit::SuitInstant& instant,
                          std::vector<positioning::Look> looks) {
  positioning::Instant step{instant.pose, std::move(looks)};
  step.pose.time = instant.captured.time_since_epoch();
  tracked_ = tracker.next(step);
}

std::optional<LivePlace> LiveTracker::pose(const suit::SuitInstant& instant) {
  if (!poses_.empty() && instant.captured <= poses_.back().captured) forget();
  poses_.push_back(instant);
  while (poses_.front().captured + kRemembered < instant.captured) poses_.pop_front();
  advance(now_, instant, {});
  if (!tracked_) return std::nullopt;
  return LivePlace{instant.captured, instant.pose, *tracked_};
}

bool LiveTracker::picture(Timestamp captured, positioning::Look look) {
  if (pictured_ && captured < *pictured_) return false;
  const auto after = std::find_if(poses_.begin(), poses_.end(), [&](const suit::SuitInstant& one) {
    return one.captured >= captured;
  });
  if (after == poses_.begin() || after == poses_.end()) return false;
  for (auto one = poses_.begin(); one != after; ++one) {
    if (!pictured_ || one->captured > *pictured_) advance(at_picture_, *one, {});
  }
  const suit::SuitInstant then = between(*std::prev(after), *after, captured);
  advance(at_picture_, then, {std::move(look)});
  pictured_place_ =
      tracked_ ? std::optional(LivePlace{captured, then.pose, *tracked_}) : std::nullopt;
  pictured_ = captured;
  now_ = at_picture_;
  for (auto one = after; one != poses_.end(); ++one) {
    if (one->captured > captured) advance(now_, *one, {});
  }
  return true;
}

}  // namespace chorus::positioner

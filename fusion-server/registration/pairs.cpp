#include "fusion-server/registration/pairs.h"

#include <algorithm>
#include <bit>
#include <numbers>

namespace chorus::registration {
namespace {

TrailMoment interpolate(const TrailFrame& before, const TrailFrame& after, Timestamp instant) {
  const double gap = seconds(after.captured - before.captured);
  const double s = gap > 0 ? seconds(instant - before.captured) / gap : 0.0;
  TrailMoment between;
  between.frame.captured = instant;
  between.frame.body = before.body;
  between.frame.seen = before.seen & after.seen;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!between.frame.has(i)) continue;
    between.frame.points[i] = (1.0 - s) * before.points[i] + s * after.points[i];
    moved += after.points[i] - before.points[i];
  }
  const int slots = std::popcount(between.frame.seen);
  if (gap > 0 && slots > 0) between.speed = moved.norm() / (slots * gap);
  return between;
}

/// Distance of the mean of the body's points from the sensor [m].
double distance_of(const TrailFrame& frame) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (frame.has(i)) sum += frame.points[i];
  }
  return sum.norm() / std::max(1, std::popcount(frame.seen));
}

bool in_range(const TrailFrame& frame, const RegistrationConfig& config) {
  const double distance = distance_of(frame);
  return distance >= config.min_distance && distance <= config.max_distance;
}

void add(Pairing& pairing, const TrailFrame& target, const TrailFrame& source,
         std::span<const Slot> slots, double time) {
  const std::size_t before = pairing.pairs.size();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!target.has(i) || !source.has(i)) continue;
    const double sigma = std::numbers::sqrt2 * slots[i].sigma;
    pairing.pairs.push_back({target.points[i], source.points[i], target.points[i].normalized(),
                             source.points[i].normalized(), sigma, i, pairing.instants, time});
  }
  if (pairing.pairs.size() > before) ++pairing.instants;
}

}  // namespace

std::optional<TrailMoment> TrailReader::at(Timestamp instant) {
  while (next_ < frames_.size() && frames_[next_].captured < instant) ++next_;
  if (next_ == frames_.size()) return std::nullopt;
  const TrailFrame& after = frames_[next_];
  if (after.captured == instant) return interpolate(after, after, instant);
  if (next_ == 0) return std::nullopt;
  const TrailFrame& before = frames_[next_ - 1];
  const bool usable = after.captured - before.captured <= max_gap_ && before.body == after.body;
  if (!usable) return std::nullopt;
  return interpolate(before, after, instant);
}

Pairing pair_up(const Trail& target, const Trail& source, const RegistrationConfig& config) {
  const std::span<const Slot> slots = slots_of(config.joints);
  TrailReader reader(target, config.max_gap);
  Pairing pairing;
  for (const TrailFrame& seen : source.frames) {
    const std::optional<TrailMoment> other = reader.at(seen.captured);
    if (!other) continue;
    ++pairing.together;
    if (!seen.moved) {
      ++pairing.resting;
    } else if (!in_range(seen, config) || !in_range(other->frame, config)) {
      ++pairing.out_of_range;
    } else if (other->speed > config.max_speed) {
      ++pairing.too_fast;
    } else {
      const double time = seconds(seen.captured - source.frames.front().captured);
      add(pairing, other->frame, seen, slots, time);
    }
  }
  return pairing;
}

}  // namespace chorus::registration

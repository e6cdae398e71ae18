#include "fusion-server/core/last_seen.h"

#include <algorithm>

namespace chorus::core {
namespace {

bool lately(Timestamp when, Timestamp now) { return now - when <= kSeenLately; }

}  // namespace

void LastSeen::add(const SensorFrame& frame) {
  Newest& own = newest_[frame.sensor];
  own.received = frame.received;
  own.bodies = frame.bodies.size();
  if (frame.bodies.empty()) return;
  own.saw = frame.received;
  own.rays = std::ranges::all_of(
      frame.bodies, [](const BodyFrame& body) { return has_rays_alone(body.skeleton.joints); });
}

void LastSeen::keep(const std::set<SensorId>& sensors) {
  std::erase_if(newest_, [&](const auto& entry) { return !sensors.contains(entry.first); });
}

std::size_t LastSeen::bodies(const SensorId& sensor, Timestamp now) const {
  const auto own = newest_.find(sensor);
  return own != newest_.end() && lately(own->second.received, now) ? own->second.bodies : 0;
}

bool LastSeen::delivers(const SensorId& sensor, Timestamp now) const {
  const auto own = newest_.find(sensor);
  return own != newest_.end() && lately(own->second.received, now);
}

bool LastSeen::sends_rays_alone(const SensorId& sensor) const {
  const auto own = newest_.find(sensor);
  return own != newest_.end() && own->second.rays;
}

std::set<SensorId> LastSeen::seeing(Timestamp now) const {
  std::set<SensorId> sensors;
  for (const auto& [sensor, own] : newest_) {
    if (own.saw != Timestamp{} && lately(own.saw, now)) sensors.insert(sensor);
  }
  return sensors;
}

}  // namespace chorus::core

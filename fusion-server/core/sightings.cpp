#include "fusion-server/core/sightings.h"

namespace chorus::core {
namespace {

bool lately(Timestamp when, Timestamp now) { return now - when <= kSeenLately; }

}  // namespace

void Sightings::add(const SensorFrame& frame) {
  Sighting& own = newest_[frame.sensor];
  own.received = frame.received;
  own.bodies = frame.bodies.size();
  if (!frame.bodies.empty()) own.saw = frame.received;
}

void Sightings::keep(const std::set<SensorId>& sensors) {
  std::erase_if(newest_, [&](const auto& entry) { return !sensors.contains(entry.first); });
}

std::size_t Sightings::bodies(const SensorId& sensor, Timestamp now) const {
  const auto own = newest_.find(sensor);
  return own != newest_.end() && lately(own->second.received, now) ? own->second.bodies : 0;
}

bool Sightings::delivers(const SensorId& sensor, Timestamp now) const {
  const auto own = newest_.find(sensor);
  return own != newest_.end() && lately(own->second.received, now);
}

std::set<SensorId> Sightings::seeing(Timestamp now) const {
  std::set<SensorId> sensors;
  for (const auto& [sensor, own] : newest_) {
    if (own.saw != Timestamp{} && lately(own.saw, now)) sensors.insert(sensor);
  }
  return sensors;
}

}  // namespace chorus::core

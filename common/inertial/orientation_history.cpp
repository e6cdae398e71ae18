#include "common/inertial/orientation_history.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace chorus::inertial {
namespace {

std::optional<Eigen::Vector3d> mixed(const std::optional<Eigen::Vector3d>& a,
                                     const std::optional<Eigen::Vector3d>& b, double share) {
  if (!a || !b) return std::nullopt;
  return Eigen::Vector3d((1.0 - share) * *a + share * *b);
}

InertialReading between(const InertialReading& before, const InertialReading& after,
                        Timestamp instant) {
  const double share =
      seconds(instant - before.captured) / seconds(after.captured - before.captured);
  InertialReading out = share < 0.5 ? before : after;
  out.captured = instant;
  out.inertial_from_sensor = before.inertial_from_sensor->slerp(share, *after.inertial_from_sensor);
  out.rate = mixed(before.rate, after.rate, share);
  out.acceleration = mixed(before.acceleration, after.acceleration, share);
  out.free_acceleration = mixed(before.free_acceleration, after.free_acceleration, share);
  out.field = mixed(before.field, after.field, share);
  out.covariance = before.covariance;
  const bool larger = after.covariance && before.covariance &&
                      after.covariance->trace() > before.covariance->trace();
  if (larger) out.covariance = after.covariance;
  return out;
}

}  // namespace

bool OrientationHistory::push(InertialFrame instant) {
  if (!instants_.empty() && instant.captured <= instants_.back().frame.captured) {
    if (instants_.back().frame.captured - instant.captured <= limits_.set_back) return false;
    instants_.clear();
    spoken_.clear();
  }
  const Timestamp oldest = instant.captured - limits_.span;
  Kept kept{{}, Timestamp::max(), Timestamp::min()};
  for (const InertialReading& reading : instant.readings) {
    if (!reading.inertial_from_sensor) continue;
    kept.first = std::min(kept.first, reading.captured);
    kept.last = std::max(kept.last, reading.captured);
    ++spoken_[reading.sensor];
  }
  kept.frame = std::move(instant);
  instants_.push_back(std::move(kept));
  while (instants_.front().frame.captured < oldest) drop_oldest();
  return true;
}

void OrientationHistory::drop_oldest() {
  for (const InertialReading& reading : instants_.front().frame.readings) {
    if (!reading.inertial_from_sensor) continue;
    const auto spoken = spoken_.find(reading.sensor);
    if (--spoken->second == 0) spoken_.erase(spoken);
  }
  instants_.pop_front();
}

/// Of each sensor the last reading until `instant`.
OrientationHistory::Readings OrientationHistory::last_until(Timestamp instant,
                                                            Duration reach) const {
  const auto captured = [](const Kept& kept) { return kept.frame.captured; };
  Readings out;
  auto one = std::ranges::upper_bound(instants_, instant + reach, {}, captured);
  while (one != instants_.begin() && out.size() < spoken_.size()) {
    --one;
    if (one->frame.captured < instant - reach) break;
    if (one->first > instant) continue;
    const auto& readings = one->frame.readings;
    for (auto reading = readings.rbegin(); reading != readings.rend(); ++reading)
      if (reading->inertial_from_sensor && reading->captured <= instant)
        out.try_emplace(reading->sensor, &*reading);
  }
  return out;
}

/// Of each sensor the first reading from `instant` on.
OrientationHistory::Readings OrientationHistory::first_from(Timestamp instant,
                                                            Duration reach) const {
  const auto captured = [](const Kept& kept) { return kept.frame.captured; };
  Readings out;
  auto one = std::ranges::lower_bound(instants_, instant - reach, {}, captured);
  for (; one != instants_.end() && one->frame.captured <= instant + reach; ++one) {
    if (out.size() == spoken_.size()) break;
    if (one->last < instant) continue;
    for (const InertialReading& reading : one->frame.readings)
      if (reading.inertial_from_sensor && reading.captured >= instant)
        out.try_emplace(reading.sensor, &reading);
  }
  return out;
}

std::vector<InertialReading> OrientationHistory::at(Timestamp instant) const {
  // Samples of one frame lie at most a gap apart; farther frames have nothing to interpolate with.
  const Duration reach = 2 * limits_.max_gap;
  const Readings before = last_until(instant, reach);
  const Readings after = first_from(instant, reach);
  std::vector<InertialReading> out;
  for (const auto& [sensor, earlier] : before) {
    const auto later = after.find(sensor);
    if (later == after.end()) continue;
    if (earlier->captured == instant) {
      out.push_back(*earlier);
    } else if (later->second->captured - earlier->captured <= limits_.max_gap) {
      out.push_back(between(*earlier, *later->second, instant));
    }
  }
  return out;
}

std::vector<Worn> worn_at(Timestamp instant,
                          const std::map<SensorId, OrientationHistory>& histories,
                          const std::map<PersonId, SensorId>& wearers) {
  std::vector<Worn> out;
  for (const auto& [person, source] : wearers) {
    const auto history = histories.find(source);
    if (history == histories.end()) continue;
    auto readings = history->second.at(instant);
    if (!readings.empty()) out.push_back({person, source, std::move(readings)});
  }
  return out;
}

}  // namespace chorus::inertial

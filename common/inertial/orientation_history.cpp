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
  if (!instants_.empty() && instant.captured <= instants_.back().captured) {
    if (instants_.back().captured - instant.captured <= limits_.set_back) return false;
    instants_.clear();
  }
  const Timestamp oldest = instant.captured - limits_.span;
  instants_.push_back(std::move(instant));
  while (instants_.front().captured < oldest) instants_.pop_front();
  return true;
}

std::vector<InertialReading> OrientationHistory::at(Timestamp instant) const {
  std::map<std::string_view, const InertialReading*> before;
  std::map<std::string_view, const InertialReading*> after;
  // Samples of one frame lie at most a gap apart; farther frames have nothing to interpolate with.
  const Duration reach = 2 * limits_.max_gap;
  auto one = std::ranges::lower_bound(instants_, instant - reach, {}, &InertialFrame::captured);
  for (; one != instants_.end() && one->captured <= instant + reach; ++one) {
    for (const InertialReading& reading : one->readings) {
      if (!reading.inertial_from_sensor) continue;
      if (reading.captured <= instant) before[reading.sensor] = &reading;
      if (reading.captured >= instant) after.try_emplace(reading.sensor, &reading);
    }
  }
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

#include "fusion-server/core/guard.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::core {
namespace {

constexpr double kRounded = 10.0;  // [mm]; a few seconds do not allow a more precise statement

SensorAlarm alarm_of(const watch::Finding& finding) {
  return {finding.shift, finding.since, finding.drifted, finding.or_else};
}

double rounded_mm(double shift) { return kRounded * std::round(to_mm(shift) / kRounded); }

bool same_places(const Registration& before, const Registration& now) {
  return std::ranges::equal(before.sensors, now.sensors, [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.world_from_sensor.isApprox(b.second.world_from_sensor);
  });
}

std::string ago(Duration passed) {
  constexpr double kMinute = 60.0;
  const double elapsed = std::max(0.0, seconds(passed));
  if (elapsed < 2.0 * kMinute) return fmt::format("{:.0f} s", elapsed);
  return fmt::format("{:.0f} min", elapsed / kMinute);
}

}  // namespace

std::string sentence_of(const SensorId& sensor, const SensorAlarm& alarm, Timestamp now,
                        bool automatic) {
  const std::string who =
      alarm.or_else ? sensor.str() + " or " + alarm.or_else->str() : sensor.str();
  const double shift = rounded_mm(alarm.shift);
  std::string text = alarm.drifted ? fmt::format("{} has drifted by about {:.0f} mm", who, shift)
                                   : fmt::format("{} was moved by about {:.0f} mm {} ago", who,
                                                 shift, ago(now - alarm.since));
  if (alarm.or_else)
    return text + "; which of the two, cannot be told from two sensors: run chorus register";
  return text + (automatic ? "; it is being placed anew: walk where it and others see you"
                           : "; run chorus register to place it anew");
}

std::string reason_of(const SensorId& sensor, const SensorAlarm& alarm) {
  return fmt::format("sensor {} {}: it saw people about {:.0f} mm from where the others saw them",
                     sensor.str(), alarm.drifted ? "has drifted" : "was moved",
                     rounded_mm(alarm.shift));
}

void Guard::look(const std::vector<Person>& people, Timestamp instant,
                 const watch::WatchConfig& config) {
  watch_.look(people, instant, config);
  auto next = watch_.finding();
  // If the same sensor is found again, the alarm keeps the time at which it began.
  if (next && finding_ && (next->sensor == finding_->sensor || next->or_else == finding_->sensor))
    next->since = std::min(next->since, finding_->since);
  finding_ = std::move(next);
}

std::optional<SensorId> Guard::moved() const {
  if (!finding_ || finding_->or_else) return std::nullopt;
  return finding_->sensor;
}

std::optional<SensorAlarm> Guard::alarm_of(const SensorId& sensor) const {
  if (const auto known = displaced_.find(sensor); known != displaced_.end()) return known->second;
  if (!finding_) return std::nullopt;
  if (finding_->sensor == sensor) return core::alarm_of(*finding_);
  if (finding_->or_else != sensor) return std::nullopt;
  SensorAlarm other = core::alarm_of(*finding_);
  other.or_else = finding_->sensor;
  return other;
}

void Guard::displaced(const SensorId& sensor) {
  if (!finding_ || finding_->sensor != sensor) return;
  displaced_[sensor] = core::alarm_of(*finding_);
  ++times_displaced_;
  finding_.reset();
  watch_.forget();
}

void Guard::released() {
  finding_.reset();
  watch_.forget();
}

void Guard::replaced(const Registration& before, const Registration& now) {
  if (!same_places(before, now)) watch_.forget();
  finding_.reset();
  std::erase_if(displaced_, [&](const auto& e) { return now.sensors.contains(e.first); });
  if (now.sensors.empty()) displaced_.clear();
}

void Guard::keep(const std::set<SensorId>& sensors) {
  const auto gone = [&](const SensorId& sensor) { return !sensors.contains(sensor); };
  if (finding_ && (gone(finding_->sensor) || (finding_->or_else && gone(*finding_->or_else)))) {
    watch_.forget();
    finding_.reset();
  }
  std::erase_if(displaced_, [&](const auto& e) { return gone(e.first); });
}

}  // namespace chorus::core

// Which sensors no longer stand where they were registered, and how that is reported.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/flow/person.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/watch/watch.h"

namespace chorus::core {

/// The finding that a sensor does not stand where it was registered.
struct SensorAlarm {
  double shift = 0.0;  ///< Distance between where it and where the others see people [m].
  Timestamp since;
  bool drifted = false;  ///< True if it happened gradually, false if at once.
  /// Set if either the sensor itself or this other one was moved: two sensors do not show which.
  std::optional<SensorId> or_else;

  bool operator==(const SensorAlarm&) const = default;
};

/// "s3 was moved by about 60 mm 12 s ago; it is being placed anew".  `automatic`: sessions start by
/// themselves.
[[nodiscard]] std::string sentence_of(const SensorId& sensor, const SensorAlarm& alarm,
                                      Timestamp now, bool automatic);

/// The reason, kept in the registration, why the sensor has no place.
[[nodiscard]] std::string reason_of(const SensorId& sensor, const SensorAlarm& alarm);

class Guard {
 public:
  void look(const std::vector<Person>& people, Timestamp instant, const watch::WatchConfig& config);

  /// The sensor whose place should be removed now; none if no sensor is known to have been moved.
  [[nodiscard]] std::optional<SensorId> moved() const;
  [[nodiscard]] std::optional<SensorAlarm> alarm_of(const SensorId& sensor) const;
  [[nodiscard]] std::optional<double> shift_of(const SensorId& sensor) const {
    return watch_.shift_of(sensor);
  }

  /// Call this when the sensor has lost its place; its alarm lasts until it has a new one.
  void displaced(const SensorId& sensor);
  /// Call this when a sensor has lost its place because somebody asked: what was found so far is
  /// given up, and nothing is told of it.
  void released();
  /// How often displaced() took an alarm.
  [[nodiscard]] std::uint64_t times_displaced() const noexcept { return times_displaced_; }
  /// Drops the current finding, and the alarms of sensors that have a place again; all alarms if no
  /// sensor has a place. If any place has changed, what was learned about shifts is forgotten, too.
  void replaced(const Registration& before, const Registration& now);
  /// Forgets sensors that are no longer configured.
  void keep(const std::set<SensorId>& sensors);

 private:
  watch::Watch watch_;
  std::optional<watch::Finding> finding_;
  std::map<SensorId, SensorAlarm> displaced_;
  std::uint64_t times_displaced_ = 0;
};

}  // namespace chorus::core

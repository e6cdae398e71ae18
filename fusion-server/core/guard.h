// Which sensors no longer stand where they were registered, and how people are told.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/status.h"
#include "fusion-server/watch/watch.h"

namespace chorus::core {

/// A sensor does not stand where its place says.
struct SensorAlarm {
  double shift = 0.0;  ///< How far from the others it saw people then [m].
  Timestamp since;
  bool drifted = false;             ///< Little by little; else at once.
  std::optional<SensorId> or_else;  ///< It, or this one: with two sensors nobody can tell.

  bool operator==(const SensorAlarm&) const = default;
};

/// "s3 was moved by about 60 mm 12 s ago; it is being placed anew".  `automatic`: sessions start by
/// themselves.
[[nodiscard]] std::string sentence_of(const SensorId& sensor, const SensorAlarm& alarm,
                                      Timestamp now, bool automatic);

/// What stays in the registration as the reason why the sensor has no place.
[[nodiscard]] std::string reason_of(const SensorId& sensor, const SensorAlarm& alarm);

class Guard {
 public:
  void look(const std::vector<Person>& people, Timestamp instant, const watch::WatchConfig& config);

  /// The sensor that should lose its place now; none: nothing is known to have moved.
  [[nodiscard]] std::optional<SensorId> moved() const;
  [[nodiscard]] std::optional<SensorAlarm> alarm_of(const SensorId& sensor) const;
  [[nodiscard]] std::optional<double> shift_of(const SensorId& sensor) const {
    return watch_.shift_of(sensor);
  }

  /// The sensor has lost its place; its alarm lasts until it has another one.
  void displaced(const SensorId& sensor);
  /// Forgets what was seen if any place is another one now.
  void replaced(const Registration& before, const Registration& now);
  /// Forgets sensors that are no longer configured.
  void keep(const std::set<SensorId>& sensors);

 private:
  watch::Watch watch_;
  std::optional<watch::Finding> finding_;
  std::map<SensorId, SensorAlarm> displaced_;
};

}  // namespace chorus::core

// When a session may start by itself again, after one that failed or was cancelled.
#pragma once

#include <map>
#include <optional>
#include <set>

#include "common/base/strong_id.h"
#include "common/time/timestamp.h"

namespace chorus::core {

/// A sensor that could not be placed starts no session for a while, and after every further failure
/// for twice as long; after a cancelled session, no sensor does.
class Retries {
 public:
  void failed(const SensorId& sensor, Timestamp now);
  /// The sensor has a place, or had one until now: earlier failures do not count any more.
  void forget(const SensorId& sensor) { sensors_.erase(sensor); }
  void cancelled(Timestamp now);
  void keep(const std::set<SensorId>& sensors);
  void clear();

  /// Until when this sensor starts no session; none: it may start one now.
  [[nodiscard]] std::optional<Timestamp> waits(const SensorId& sensor, Timestamp now) const;
  /// No session starts by itself before this time.
  [[nodiscard]] Timestamp not_before() const noexcept { return not_before_; }

 private:
  struct Retry {
    int failures = 0;
    Timestamp not_before;
  };

  std::map<SensorId, Retry> sensors_;
  Timestamp not_before_{};
};

}  // namespace chorus::core

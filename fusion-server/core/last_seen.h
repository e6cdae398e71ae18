// Which sensors deliver frames, and how many bodies they see; independent of whether they have a
// place.
#pragma once

#include <cstddef>
#include <map>
#include <set>

#include "common/base/strong_id.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"

namespace chorus::core {

/// A frame counts as recent for this long after its receipt.
inline constexpr Duration kSeenLately = std::chrono::seconds(2);

class LastSeen {
 public:
  void add(const SensorFrame& frame);
  void keep(const std::set<SensorId>& sensors);  ///< Forgets all other sensors.

  /// Number of bodies in the sensor's newest frame; zero when the frame is old.
  [[nodiscard]] std::size_t bodies(const SensorId& sensor, Timestamp now) const;
  [[nodiscard]] bool delivers(const SensorId& sensor, Timestamp now) const;
  /// Sensors that recently saw a body.
  [[nodiscard]] std::set<SensorId> seeing(Timestamp now) const;
  /// True if the last body that the sensor saw had directions alone, without depth.
  [[nodiscard]] bool sends_rays_alone(const SensorId& sensor) const;

 private:
  struct Newest {
    Timestamp received;  ///< When its newest frame came.
    std::size_t bodies = 0;
    Timestamp saw{};    ///< When its last frame with a body came.
    bool rays = false;  ///< That body had rays alone.
  };
  std::map<SensorId, Newest> newest_;
};

}  // namespace chorus::core

// Refuses bodies that cannot be a person's before anything uses them, and gives the reason.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "common/base/strong_id.h"
#include "common/body/skeleton.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"

namespace chorus::associate {

struct BodyLimits {
  double max_range = 12.0;  ///< From the sensor to the middle of the body [m].
  double max_reach = 2.0;   ///< From the middle of the body to any of its joints [m].
  /// If ten or more joints are seen, the farthest is at least this far from the middle [m].
  double min_reach = 0.15;
  /// How long a body may keep exactly the same coordinates; a real sensor hardly ever measures
  /// exactly the same coordinates twice.
  Duration max_frozen = std::chrono::seconds(2);

  bool operator==(const BodyLimits&) const = default;
};

/// Human-readable: why this cannot be a person's body; empty if it can.
[[nodiscard]] std::string_view implausible(const Skeleton<SensorSpace>& body,
                                           const BodyLimits& limits);

/// Finds bodies of one sensor that have identical coordinates under new time stamps.
class FrozenBodies {
 public:
  /// Removes bodies that have been frozen for too long; returns their number.
  std::size_t remove_from(SensorFrame& frame, const BodyLimits& limits);

 private:
  struct Still {
    std::uint64_t coordinates = 0;  ///< A hash of the coordinates.
    Timestamp since;                ///< Capture of the first frame that had them.
  };
  std::map<BodyId, Still> bodies_;  ///< The bodies of the last frame.
};

}  // namespace chorus::associate

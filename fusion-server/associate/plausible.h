// Refuses bodies that cannot be a person's before they are used, and gives the reason.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "fusion-server/flow.h"

namespace chorus::associate {

struct BodyLimits {
  double max_range = 12.0;  ///< From the sensor to the middle of the body [m].
  double max_reach = 2.0;   ///< From the middle of the body to any of its joints [m].
  double min_reach = 0.15;  ///< The farthest of ten or more joints is at least this far [m].
  /// A real sensor never measures the same coordinates to the last digit for this long.
  Duration max_frozen = std::chrono::seconds(2);

  bool operator==(const BodyLimits&) const = default;
};

/// Why this cannot be a person's body, as text for people; empty: it can.
[[nodiscard]] std::string_view implausible(const Skeleton<SensorSpace>& body,
                                           const BodyLimits& limits);

/// Watches one sensor's bodies for identical coordinates under new time stamps.
class FrozenBodies {
 public:
  /// Removes from the frame the bodies that have been frozen for too long; returns how many.
  std::size_t remove_from(SensorFrame& frame, const BodyLimits& limits);

 private:
  struct Still {
    std::uint64_t coordinates = 0;  ///< A hash of the coordinates.
    Timestamp since;                ///< Capture of the first frame that had them.
  };
  std::map<BodyId, Still> bodies_;  ///< Of the last frame.
};

}  // namespace chorus::associate

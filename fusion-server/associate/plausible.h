// Bodies that are not a person's: refused before anything is made of them, with the reason.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "fusion-server/flow.h"

namespace chorus::associate {

struct BodyLimits {
  double max_range = 12.0;  ///< From the sensor to the middle of the body [m].
  double max_reach = 2.0;   ///< From the middle of the body to any of its joints [m].
  double min_reach = 0.15;  ///< To the farthest of ten joints or more [m].
  /// A real sensor never measures the same coordinates to the last digit for this long.
  Duration max_frozen = std::chrono::seconds(2);

  bool operator==(const BodyLimits&) const = default;
};

/// Why this is not a person's body, for people to read; empty: it may be one.
[[nodiscard]] std::string_view implausible(const Skeleton<SensorSpace>& body,
                                           const BodyLimits& limits);

/// Watches the bodies of one sensor for coordinates that are repeated under new time stamps.
class FrozenBodies {
 public:
  /// Removes the bodies that have been frozen for too long from the frame; returns how many.
  std::size_t remove_from(SensorFrame& frame, const BodyLimits& limits);

 private:
  struct Still {
    std::uint64_t coordinates = 0;  ///< A hash of them.
    Timestamp since;                ///< Capture of the first frame that had them.
  };
  std::map<BodyId, Still> bodies_;  ///< Of the last frame.
};

}  // namespace chorus::associate

#include "fusion-server/core/common_clock.h"

#include <algorithm>
#include <optional>

namespace chorus::core {

void keep_near_ours(Registration& registration) {
  std::optional<Duration> youngest;
  for (const auto& [sensor, clock] : registration.clocks) {
    if (exchanges_time(seconds(clock.stated)) || !clock.least_age) return;
    const Duration age = *clock.least_age - clock.added;
    youngest = std::min(youngest.value_or(age), age);
  }
  if (!youngest) return;
  const Duration by = *youngest - std::clamp(*youngest, Duration{0}, kOldestFrames);
  for (auto& [sensor, clock] : registration.clocks) clock.added += by;
}

}  // namespace chorus::core

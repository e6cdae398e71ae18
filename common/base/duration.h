// Duration: nanoseconds, for both clocks.  It has its own header so that configs can use durations
// without including the clocks.
#pragma once

#include <chrono>

namespace chorus {

using Duration = std::chrono::nanoseconds;

/// An instant of the steady clock, for time-outs.  For UTC see Timestamp (common/time).
using SteadyTime = std::chrono::steady_clock::time_point;

/// Seconds as a double, for formulas and reports.
[[nodiscard]] constexpr double seconds(Duration d) noexcept {
  return std::chrono::duration<double>(d).count();
}

/// A duration from seconds; rounds to the nearest nanosecond.
[[nodiscard]] constexpr Duration from_seconds(double s) noexcept {
  return Duration(static_cast<Duration::rep>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

}  // namespace chorus

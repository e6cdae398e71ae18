// Capture times for formats that number frames but store no times.
#pragma once

#include <cstddef>

#include "common/time/timestamp.h"

namespace chorus::importers {

/// Nominal rate of Kinect v1 and v2; real devices drop frames.
inline constexpr int kKinectHz = 30;

/// The value of the note "time" in recordings with such times.
inline constexpr const char* kUniformTimeNote =
    "no times in the file; an exact 30 Hz is assumed, dropped frames are invisible";

/// The instant of frame `index`, rounded to the nearest nanosecond; errors do not accumulate.  The
/// pipeline's grid is computed in the same way.
[[nodiscard]] constexpr Timestamp uniform_instant(Timestamp start, std::size_t index, int hz) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  const auto twice = 2 * static_cast<std::int64_t>(index) * kNanosecondsPerSecond / hz;
  return start + Duration((twice + 1) / 2);
}

}  // namespace chorus::importers

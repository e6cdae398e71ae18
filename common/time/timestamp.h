// One time type: UTC nanoseconds since the Unix epoch.  Capture time unless a name says otherwise.
//
// Timestamp has its own clock type, so UTC can never be subtracted from steady time.  UTC can be
// stepped (NTP), so this clock is not steady: use std::chrono::steady_clock for time-outs, never
// this one.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/duration.h"
#include "common/base/result.h"

namespace chorus {

struct NtpClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<NtpClock, Duration>;
  static constexpr bool is_steady = false;
};

using Timestamp = NtpClock::time_point;

[[nodiscard]] constexpr Timestamp from_unix_ns(std::int64_t ns) noexcept {
  return Timestamp(Duration(ns));
}
[[nodiscard]] constexpr std::int64_t to_unix_ns(Timestamp t) noexcept {
  return t.time_since_epoch().count();
}

/// "2026-11-21T07:30:00.123456789Z": xsd:dateTime, always with nine fractional digits and Z.
[[nodiscard]] std::string to_iso8601(Timestamp t);

/// Reads xsd:dateTime with Z or an offset and with 0-9 fractional digits; years 1970-2261.
[[nodiscard]] Result<Timestamp> parse_iso8601(std::string_view text);

}  // namespace chorus

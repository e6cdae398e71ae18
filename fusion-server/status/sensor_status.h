// What the fusion server knows of one sensor: whether its frames come, when, and of what use they
// are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/base/duration.h"
#include "common/base/strong_id.h"
#include "common/time/ntp_status.h"
#include "fusion-server/flow/latency.h"

namespace chorus {

/// Counts, since the start, of a sensor's frames that came late, twice or with a wrong time.
struct FrameFates {
  std::uint64_t late = 0;       ///< Frames that came after a newer one; they were inserted before
                                ///< it.
  std::uint64_t doubled = 0;    ///< Frames with the capture time of an earlier frame; left out.
  std::uint64_t early = 0;      ///< Frames with a time in the future; left out.
  std::uint64_t backwards = 0;  ///< Frames numbered after the newest one but captured before it;
                                ///< left out.
  std::uint64_t stale = 0;      ///< Frames that came too late to be of use; left out.
  std::uint64_t restarts = 0;   ///< How often several frames in a row showed that the sensor's
                                ///< clock was set back or its device restarted.

  bool operator==(const FrameFates&) const = default;
};

/// The number of frames left out because of their time, not counting duplicates.
[[nodiscard]] constexpr std::uint64_t refused(const FrameFates& fates) {
  return fates.early + fates.backwards + fates.stale;
}

struct SensorStatus {
  SensorId id;
  std::string url;
  std::string state;       ///< "live", "connecting", "lost", "refused"
  std::string last_error;  ///< What is wrong at present; empty if nothing is.
  bool streaming = false;  ///< True while its frames come by event stream instead of polling.
  /// Time since the capture of its newest frame, by our clock; none: no frame yet.
  std::optional<Duration> age;
  double rate_hz = 0.0;
  std::size_t bodies = 0;  ///< Number of bodies in its newest frame.
  /// Largest Otto weight of its views; none: the fusion method uses no weights.
  std::optional<double> weight;
  double share = 0.0;  ///< Share of the joints fused in the last second to which it contributed.
  double share_afterwards = 0.0;  ///< The same, including its late frames, as /frame?at= shows it.
  /// Share of the instants that waited for this sensor as long as they could.
  double awaited = 0.0;
  /// Our clock minus the sensor's, as estimated from the answers of the sensor's host.
  std::optional<Duration> clock_offset;
  std::optional<Duration> clock_uncertainty;
  bool clock_corrected = false;  ///< True if the offset is added to its capture times.
  /// Added to its capture times as well, because a walk showed that its clock is off.
  std::optional<Duration> walked_offset;
  std::optional<Duration> walked_sigma;
  /// True if that offset is only a guess from how old its frames arrive: the sensor walked alone,
  /// so no other one told the time.
  bool guessed_from_age = false;
  std::optional<Latency> latency;  ///< As the last walk told it.
  std::optional<NtpStatus> host;   ///< What the sensor's host says of its own clock.
  std::uint64_t frames = 0;        ///< Frames received from it since the start.
  std::uint64_t missed = 0;   ///< Frames missing from the sensor's numbering: neither delivered
                              ///< nor filled in later.
  std::uint64_t refused = 0;  ///< Frames left out because of their time, see refused() above.
  /// What happened to frames with a wrong time; the early, backwards and stale ones are also in
  /// `refused`.
  FrameFates fates;
  std::uint64_t failures = 0;  ///< Requests without a usable answer.

  /// How far this sensor now sees people from where it would usually see them, as compared with the
  /// others [m]; none until somebody has walked in view of it and of another one.
  std::optional<double> shift;
  /// Says in a sentence for people that the sensor was moved, or sees people where others see
  /// nobody; empty if nothing of the kind is known.
  std::string alarm;
  /// Says in such a sentence who contradicts what the sensor sees at present; empty: nobody.
  std::string contested;
  std::uint64_t contests = 0;  ///< How many bodies it has seen that were not published for that.

  bool operator==(const SensorStatus&) const = default;
};

/// Our clock minus the sensor's, from everything that is known about it; none if nothing is known.
[[nodiscard]] inline std::optional<Duration> total_offset(const SensorStatus& sensor) {
  if (!sensor.clock_offset && !sensor.walked_offset) return std::nullopt;
  return sensor.clock_offset.value_or(Duration{0}) + sensor.walked_offset.value_or(Duration{0});
}

}  // namespace chorus

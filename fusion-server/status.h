// What the fusion server knows of itself besides the fused bodies: its sensors and its
// registration.
//
// A value, replaced whole a few times a second; readers hold a shared_ptr to a constant one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/histogram.h"
#include "fusion-server/flow.h"

namespace chorus {

struct SensorStatus {
  SensorId id;
  std::string url;
  std::string state;            ///< "live", "connecting", "lost", "refused"
  std::string last_error;       ///< What is wrong now; empty: nothing.
  bool streaming = false;       ///< Its frames come by event stream, not by polling.
  std::optional<Duration> age;  ///< Since the newest capture, by our clock; none: no frame yet.
  double rate_hz = 0.0;
  std::size_t bodies = 0;
  double weight = 0.0;
  double share = 0.0;                    ///< Of all fused joints, those it contributed to, lately.
  double share_afterwards = 0.0;         ///< The same with its late frames, as /frame?at= has it.
  double awaited = 0.0;                  ///< Of all instants, those that waited for it to the last.
  std::optional<Duration> clock_offset;  ///< Ours minus theirs.
  std::optional<Duration> clock_uncertainty;
  bool clock_corrected = false;  ///< The offset is larger than its uncertainty, so it is applied.
  std::uint64_t frames = 0;      ///< Delivered since start.
  std::uint64_t missed = 0;      ///< Gaps in the sensor's own sequence that were not filled.
  std::uint64_t refused = 0;     ///< Frames that went back in time, or of quite another time.
  std::uint64_t failures = 0;    ///< Requests without a usable answer.

  bool operator==(const SensorStatus&) const = default;
};

struct SessionStatus {
  bool collecting = false;
  double elapsed = 0.0;              ///< [s]
  double target = 0.0;               ///< [s]
  std::vector<std::string> reasons;  ///< What the last solve lacked, when it was not adopted.

  bool operator==(const SessionStatus&) const = default;
};

struct Counters {
  std::uint64_t ticks = 0;  ///< Snapshots published.
  /// Instants left out because the host was suspended or overloaded.
  std::uint64_t ticks_skipped = 0;
  std::uint64_t frames_dropped = 0;  ///< Lost between poller and pipeline.
  std::uint64_t steps_failed = 0;    ///< Turns of the pipeline that broke.
  std::uint64_t jobs_failed = 0;     ///< Of the registration worker.
  double step_seconds = 0.0;         ///< Fusing frames and handing them over, on a steady clock.
  Histogram::Snapshot age;           ///< Instant to publication [s].
};

struct Status {
  std::vector<SensorStatus> sensors;
  Registration registration;
  SessionStatus session;
  Counters counters;
};

}  // namespace chorus

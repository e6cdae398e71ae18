// What the fusion server knows about itself besides the fused bodies: its sensors and its
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
  std::size_t bodies = 0;         ///< In its newest frame.
  double weight = 0.0;            ///< Largest Otto weight of its views; only "otto" methods use it.
  double share = 0.0;             ///< Share of all fused joints that it contributed to, lately.
  double share_afterwards = 0.0;  ///< The same with its late frames, as /frame?at= has it.
  double awaited = 0.0;           ///< Share of all instants that waited for it to the last.
  std::optional<Duration> clock_offset;  ///< Ours minus theirs.
  std::optional<Duration> clock_uncertainty;
  bool clock_corrected = false;  ///< The offset is larger than its uncertainty, so it is applied.
  std::uint64_t frames = 0;      ///< Delivered since start.
  std::uint64_t missed = 0;      ///< Gaps in the sensor's own sequence that were not filled.
  std::uint64_t refused = 0;     ///< Frames that went back in time or had an implausible time.
  std::uint64_t failures = 0;    ///< Requests without a usable answer.

  bool operator==(const SensorStatus&) const = default;
};

enum class SessionState {
  Collecting,  ///< Watching somebody walk.
  Solving,     ///< The walk is over; its last solve runs.
  Done,        ///< Verdict and reasons are final.
  Cancelled,
};

/// One registration session: its progress, then its outcome.
struct SessionStatus {
  std::uint64_t id = 0;  ///< Rises; never reused.
  SessionState state = SessionState::Done;
  bool automatic = false;  ///< Started by itself.
  Timestamp started;
  double elapsed = 0.0;             ///< Walk seen so far [s].
  double target = 0.0;              ///< [s]
  Verdict verdict = Verdict::None;  ///< Of its last solve.
  bool adopted = false;             ///< What it found is in use, or was, and was not withdrawn.
  /// What the last solve lacked, and what happened to its result.
  std::vector<std::string> reasons;

  bool operator==(const SessionStatus&) const = default;
};

[[nodiscard]] constexpr bool running(const SessionStatus& session) {
  return session.state == SessionState::Collecting || session.state == SessionState::Solving;
}

/// Where the registration is stored across restarts.
struct StorageStatus {
  std::string folder;   ///< Empty: nowhere.
  std::string trouble;  ///< Why the last attempt to store failed; empty: it did not.

  bool operator==(const StorageStatus&) const = default;
};

[[nodiscard]] inline bool stored(const StorageStatus& storage) {
  return !storage.folder.empty() && storage.trouble.empty();
}

/// The progress of registering, beside the registration in use.
struct RegistrationProgress {
  std::vector<SessionStatus> sessions;  ///< The last few, newest first.
  std::uint64_t next_session = 1;       ///< Id of the next one.
  std::vector<std::string> awaits;      ///< What is missing now, one sentence for people each.
  StorageStatus storage;
  std::uint64_t commands = 0;  ///< How many commands of clients have taken effect.
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
  RegistrationProgress progress;
  Counters counters;
};

}  // namespace chorus

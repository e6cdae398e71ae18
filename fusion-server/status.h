// The state of the fusion server apart from the fused bodies: its sensors and its registration.
//
// A plain value, replaced as a whole a few times a second.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/histogram.h"
#include "common/time/ntp_status.h"
#include "fusion-server/flow.h"

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
  std::optional<NtpStatus> host;  ///< What the sensor's host says of its own clock.
  std::uint64_t frames = 0;       ///< Frames received from it since the start.
  std::uint64_t missed = 0;       ///< Frames missing from the sensor's numbering: neither delivered
                                  ///< nor filled in later.
  std::uint64_t refused = 0;      ///< Frames left out because of their time, see refused() above.
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

  bool operator==(const SensorStatus&) const = default;
};

/// Our clock minus the sensor's, from everything that is known about it; none if nothing is known.
[[nodiscard]] inline std::optional<Duration> total_offset(const SensorStatus& sensor) {
  if (!sensor.clock_offset && !sensor.walked_offset) return std::nullopt;
  return sensor.clock_offset.value_or(Duration{0}) + sensor.walked_offset.value_or(Duration{0});
}

enum class SessionState {
  Collecting,  ///< Waiting for somebody to walk long enough.
  Solving,     ///< The walk is over; its final solve is running.
  Done,        ///< Verdict and reasons are final.
  Cancelled,
};

/// What two sensors saw together during a session.
struct PairCoverage {
  SensorId first;
  SensorId second;
  std::size_t sightings = 0;  ///< Instants at which both saw the only person.
  double spread = 0.0;        ///< RMS distance of the person's places at these instants from their
                              ///< mean [m].
  /// 95 % radius of the place of one sensor relative to the other, as it is to be expected [m].
  double expected = 0.0;

  bool operator==(const PairCoverage&) const = default;
};

/// A square of half a metre of the floor on which somebody walked.
struct CoveredCell {
  double x = 0.0;           ///< x of its middle, world [m].
  double z = 0.0;           ///< [m]
  std::size_t sensors = 0;  ///< Number of sensors that saw somebody there.

  bool operator==(const CoveredCell&) const = default;
};

/// How accurately a session has placed one sensor so far.
struct SensorAccuracy {
  SensorId sensor;
  /// 95 % radius of the sensor's place on the floor, relative to the master [m]; none: the last
  /// solve did not place the sensor.
  std::optional<double> radius;

  bool operator==(const SensorAccuracy&) const = default;
};

/// When the result of a session comes into use.
enum class Adoption {
  AtOnce,
  /// After somebody has accepted it, if another registration is in use; else at once.
  WhenAccepted,
};

/// What a proposed registration would change for one sensor.
struct PlaceChange {
  SensorId sensor;
  /// 95 % radii of the sensor's place on the floor, relative to the master [m], in the registration
  /// in use and in the proposed one; none: it has no place there, or the radius is not known.
  std::optional<double> radius_now;
  std::optional<double> radius_then;
  /// How far the sensor would move [m] and turn [rad]; none: it has no place in one of the two.
  std::optional<double> shift;
  std::optional<double> turn;

  bool operator==(const PlaceChange&) const = default;
};

/// The result of a session that waits until somebody accepts or declines it.
struct Proposal {
  std::uint64_t session = 0;
  Registration registration;  ///< In the world of the one in use.
  std::vector<PlaceChange> changes;
};

/// One registration session: its progress, then its outcome.
struct SessionStatus {
  std::uint64_t id = 0;  ///< Increases with each session; never reused.
  SessionState state = SessionState::Done;
  bool automatic = false;  ///< True if the server started it without a client's request.
  Adoption adoption = Adoption::AtOnce;
  Timestamp started;
  double elapsed = 0.0;             ///< Length of the walk collected so far [s].
  double target = 0.0;              ///< Length of the walk that is wanted [s].
  Verdict verdict = Verdict::None;  ///< The verdict of the last solve.
  bool adopted = false;  ///< True if its result is, or was, in use and was not withdrawn.
  /// What was wrong with the last solve, and what became of its result.
  std::vector<std::string> reasons;
  /// The session ends by itself once all sensors are placed with this radius or less [m]; 0: never.
  double target_radius = 0.0;
  bool reached = false;                  ///< True once the session ends because of `target_radius`.
  std::vector<SensorAccuracy> accuracy;  ///< One entry for each sensor of the last solve.
  std::vector<PairCoverage> pairs;       ///< What each pair of sensors has seen together.
  std::vector<CoveredCell> cells;        ///< Where people walked; empty until sensors have places.

  bool operator==(const SessionStatus&) const = default;
};

[[nodiscard]] constexpr bool running(const SessionStatus& session) {
  return session.state == SessionState::Collecting || session.state == SessionState::Solving;
}

/// Where the registration is kept across restarts.
struct StorageStatus {
  std::string folder;   ///< Empty: the registration is not kept.
  std::string trouble;  ///< Why the last attempt to store something failed; empty if none did.
  /// What was wrong with the file at the start, and what became of it; empty once a registration
  /// has been stored, or if nothing was.
  std::string damage;
  bool writing = false;  ///< True until the registration put into use last has been written.

  bool operator==(const StorageStatus&) const = default;
};

/// The progress of registration; the registration in use is separate.
struct RegistrationProgress {
  std::vector<SessionStatus> sessions;  ///< The last few, newest first.
  std::uint64_t next_session = 1;       ///< Id of the next one.
  std::vector<std::string> awaits;      ///< What is missing at present, as sentences for people.
  std::optional<Registration> earlier;  ///< The one in use before; an undo returns to it.
  std::optional<Proposal> proposal;     ///< Waits to be accepted or declined.
  std::vector<std::string> alarms;      ///< The alarms of all sensors, for people.
  StorageStatus storage;
  /// True while the registration in use is one that the running session has put there; it is stored
  /// at the session's end.
  bool own_provisional = false;
  std::vector<SensorId> unpolled;  ///< Sensors with a place that are not configured.
  std::uint64_t commands = 0;      ///< How many commands of clients were carried out.
};

/// Whether the registration in use is the one that the next start would find.
[[nodiscard]] inline bool stored(const RegistrationProgress& progress) {
  const StorageStatus& storage = progress.storage;
  return !storage.folder.empty() && storage.trouble.empty() && !storage.writing &&
         !progress.own_provisional;
}

struct Counters {
  std::uint64_t ticks = 0;  ///< Snapshots published.
  /// Instants left out because the host was suspended or overloaded.
  std::uint64_t ticks_skipped = 0;
  std::uint64_t displaced = 0;       ///< How often a sensor lost its place because it was moved.
  std::uint64_t frames_dropped = 0;  ///< Frames lost between poller and pipeline.
  std::uint64_t steps_failed = 0;    ///< Runs of the pipeline that threw an exception.
  std::uint64_t jobs_failed = 0;     ///< Jobs of the registration worker that threw an exception.
  double step_seconds = 0.0;         ///< Time spent fusing and handing over, by a steady clock.
  Histogram::Snapshot age;           ///< Time from instant to publication [s].
};

struct Status {
  std::vector<SensorStatus> sensors;
  Registration registration;
  RegistrationProgress progress;
  Counters counters;
};

}  // namespace chorus

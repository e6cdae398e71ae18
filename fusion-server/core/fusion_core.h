// Everything the pipeline thread owns: histories, tracks, registration and its session.
//
// No thread, no socket, no clock: frames, commands and solutions go in, snapshots and jobs come
// out.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/core/hindsight.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/registration/registration.h"
#include "fusion-server/status.h"

namespace chorus::core {

struct CoreConfig {
  TickConfig output;
  pipeline::PipelineConfig pipeline;
  registration::RegistrationConfig registration;
  SessionConfig session;
  std::set<SensorId> sensors;  ///< Frames of others are ignored.
  std::uint64_t first_sequence = 1;
};

/// A solve for the worker thread.
struct SolveJob {
  std::uint64_t session = 0;
  SolveKind kind = SolveKind::Provisional;
  std::vector<registration::WalkTrack> walk;
  registration::RegistrationConfig config;
};

struct Solution {
  std::uint64_t session = 0;
  SolveKind kind = SolveKind::Provisional;
  Registration registration;
};

class FusionCore {
 public:
  FusionCore(CoreConfig config, Registration registration);

  void reconfigure(CoreConfig config);
  void take(const SensorFrame& frame);

  /// The next snapshot when its time has come.
  [[nodiscard]] std::optional<Snapshot> tick(Timestamp now);
  /// An earlier snapshot once more, now with the frames that came too late for it: the people's ids
  /// are the same.  Ask after each tick; none is the rule.
  [[nodiscard]] std::optional<Snapshot> amended(Timestamp now);
  /// How long nothing will come unless a frame arrives.
  [[nodiscard]] Duration idle(Timestamp now);

  /// Starts a session; Conflict when one is running.
  [[nodiscard]] Result<void> start_session(Duration target);
  /// Cancels the session and forgets the registration.
  void forget();

  /// At most one job is out at a time; its solution comes back through solved().
  [[nodiscard]] std::optional<SolveJob> due_job(Timestamp now);
  /// True when the registration was replaced.
  bool solved(Solution solution);

  [[nodiscard]] const Registration& registration() const noexcept { return registration_; }
  [[nodiscard]] SessionStatus session() const;
  [[nodiscard]] const std::vector<SensorReport>& reports() const noexcept { return reports_; }
  [[nodiscard]] std::uint64_t refused(const SensorId& sensor) const;
  /// Frames of this sensor have been refused within the last seconds.
  [[nodiscard]] bool refuses(const SensorId& sensor, Timestamp now) const;
  [[nodiscard]] Share share(const SensorId& sensor) const { return shares_.of(sensor); }
  [[nodiscard]] std::uint64_t skipped() const noexcept { return schedule_.skipped(); }

 private:
  struct Refusals {
    std::uint64_t count = 0;
    Timestamp last;  ///< Receipt of the last refused frame.
  };

  void start_by_itself(Timestamp now);
  [[nodiscard]] bool improves(const Answered& answered, Timestamp now) const;
  [[nodiscard]] std::vector<std::string> shortfalls(const Registration& candidate) const;

  CoreConfig config_;
  TickSchedule schedule_;
  pipeline::Histories histories_;
  pipeline::Memory memory_;
  Registration registration_;
  RegistrationSession session_;
  std::uint64_t session_number_ = 0;
  bool solving_ = false;
  std::vector<std::string> session_reasons_;
  std::map<SensorId, Timestamp> saw_body_;  ///< By our clock.
  std::map<SensorId, Refusals> refused_;
  std::vector<SensorId> awaited_;  ///< When the pending instant was last asked about.
  Hindsight hindsight_;
  Shares shares_;
  std::vector<SensorReport> reports_;
};

}  // namespace chorus::core

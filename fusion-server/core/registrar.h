// The registration in use, the session that improves it, and the record of the last few sessions.
//
// No thread, no socket, no clock: frames, wishes and solutions go in, solve jobs come out.  A
// session's provisional registrations are its own: when its last solve is refused they are taken
// back.  A sensor that could not be placed does not start sessions by itself again and again.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "fusion-server/core/adoption.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/sightings.h"
#include "fusion-server/status.h"

namespace chorus::core {

/// A solve for the worker thread.
struct SolveJob {
  std::uint64_t session = 0;
  SolveKind kind = SolveKind::Provisional;
  SharedWalk walk;
  registration::RegistrationConfig config;
  std::stop_token stop;  ///< Its result is not wanted any more.
};

struct Solution {
  std::uint64_t session = 0;
  SolveKind kind = SolveKind::Provisional;
  Registration registration;
  Duration cost{0};       ///< How long the solve took.
  bool given_up = false;  ///< Stopped half-way: no result.
};

struct RegistrarConfig {
  registration::RegistrationConfig registration;
  SessionConfig session;
  std::set<SensorId> sensors;
};

/// What became of a solution.
enum class Outcome {
  Nothing,    ///< The registration in use stays.
  Adopted,    ///< It was replaced or extended.
  Withdrawn,  ///< The session's own provisional one was taken back.
};

class Registrar {
 public:
  Registrar(RegistrarConfig config, Registration registration, std::uint64_t first_session);

  void reconfigure(RegistrarConfig config);
  void take(const SensorFrame& frame);

  /// Starts a session, or takes over the one that runs by itself, and returns its id; Conflict when
  /// somebody has started the one that runs.
  [[nodiscard]] Result<std::uint64_t> start(Duration target, Timestamp now);
  /// Ends this session as if it had never been; NotFound when it does not run.
  [[nodiscard]] Result<void> cancel(std::uint64_t session, Timestamp now);
  /// Cancels the session and forgets the registration.
  void forget();

  /// At most one job is out at a time; its solution comes back through solved().
  [[nodiscard]] std::optional<SolveJob> due_job(Timestamp now);
  Outcome solved(Solution solution, Timestamp now);

  [[nodiscard]] const Registration& registration() const noexcept { return registration_; }
  [[nodiscard]] const Sightings& sightings() const noexcept { return sightings_; }
  /// Newest first.
  [[nodiscard]] std::vector<SessionStatus> sessions() const;
  [[nodiscard]] std::uint64_t next_session() const noexcept { return next_session_; }
  /// What is missing for (a better) registration, one sentence for a person each.
  [[nodiscard]] std::vector<std::string> awaits(Timestamp now) const;

 private:
  struct Retry {
    int failures = 0;
    Timestamp not_before;
  };

  void begin(Duration target, bool automatic, Timestamp now);
  void start_by_itself(Timestamp now);
  void end_session(SessionState state);
  void replace(Registration next);
  [[nodiscard]] bool take_back();
  Outcome settle_provisional(const Registration& candidate);
  Outcome settle_final(const Registration& candidate, Timestamp now);
  void explain_refusal(const Registration& candidate, const Error& why, bool withdrawn);
  void back_off(const Registration& candidate, Timestamp now);
  [[nodiscard]] std::vector<std::string> shortfalls(const Registration& candidate) const;
  [[nodiscard]] bool waits(const SensorId& sensor, Timestamp now) const;
  [[nodiscard]] std::optional<Duration> retry_in(Timestamp now) const;

  RegistrarConfig config_;
  Registration registration_;
  RegistrationSession session_;
  Sightings sightings_;
  std::uint64_t next_session_;
  std::deque<SessionStatus> sessions_;  ///< Newest first; its front is the one that runs, if any.
  std::optional<Registration> before_;  ///< Set while what is in use is the session's own.
  bool solving_ = false;
  std::stop_source stop_solve_;
  SolveKind solving_kind_ = SolveKind::Provisional;
  std::map<SensorId, Retry> retries_;
  Timestamp not_before_{};  ///< No session by itself earlier.
};

}  // namespace chorus::core

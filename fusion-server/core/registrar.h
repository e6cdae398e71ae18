// The registration in use, the session that improves it, and a record of the last sessions.
//
// It uses no thread, socket or clock: frames, requests and solutions go in, solve jobs come out.
// Provisional registrations belong to the session, and are withdrawn when its final solve is
// refused.  A sensor that could not be placed does not start sessions again and again.  A result
// that has to be accepted first, because a client wants that or because places of it are
// unconfirmed, waits as a proposal: until it is accepted or declined, until the
// registration in use becomes another one, or until the server ends.
#pragma once

#include <deque>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "fusion-server/core/last_seen.h"
#include "fusion-server/core/places_in_use.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/retries.h"
#include "fusion-server/core/solve_job.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/registration_progress.h"
#include "fusion-server/status/session_status.h"

namespace chorus::core {

struct RegistrarConfig {
  registration::RegistrationConfig registration;
  SessionConfig session;
  std::set<SensorId> sensors;
};

class Registrar {
 public:
  Registrar(RegistrarConfig config, Registration registration, std::uint64_t first_session);

  void reconfigure(RegistrarConfig config);
  void take(const SensorFrame& frame);

  /// Starts a session, or takes over an automatic one that is running, and returns its id; Conflict
  /// when the running one was started by hand.
  [[nodiscard]] Result<std::uint64_t> start(Duration target, Timestamp now,
                                            Adoption adoption = Adoption::AtOnce);
  /// Cancels this session and withdraws what it changed; NotFound when it is not running.
  [[nodiscard]] Result<void> cancel(std::uint64_t session, Timestamp now);
  /// Cancels the session and forgets the registration; the next one is moved into the same world.
  void forget();
  /// Exchanges the registration in use with the previous one, so a second call undoes the first.
  /// Conflict while a session is running; NotFound when there is no previous one, or when none of
  /// its sensors is configured any more.
  [[nodiscard]] Result<void> undo();
  /// Puts the proposed registration into use.  Conflict while a session is running; NotFound when
  /// none is proposed.
  [[nodiscard]] Result<void> accept();
  /// Keeps the registration in use and forgets the proposed one; NotFound when none is proposed.
  [[nodiscard]] Result<void> decline();
  /// No session starts by itself while there is one.
  [[nodiscard]] const std::optional<Proposal>& proposal() const noexcept {
    return places_.proposal();
  }
  /// The registration that undo() goes back to; set at the start from what is stored.
  [[nodiscard]] const std::optional<Registration>& earlier() const noexcept {
    return places_.earlier();
  }
  void set_earlier(Registration registration) { places_.set_earlier(std::move(registration)); }

  /// Removes the place of a sensor that was moved. The others keep theirs, and a session for this
  /// sensor may start at once. False while a session is running, if the sensor has no place, or if
  /// fewer than two others have one.
  [[nodiscard]] bool displace(const SensorId& sensor, const std::string& reason);
  /// Removes the place of a sensor, and its pause after failed sessions, because somebody asked to
  /// have it registered anew; a session for it may start at once.  Conflict while a session is
  /// running, and if fewer than two others have a place; NotFound for a sensor that is not
  /// followed.
  [[nodiscard]] Result<void> release(const SensorId& sensor);
  /// Conflict while a session is running; NotFound and InvalidArgument as with_origin().
  [[nodiscard]] Result<void> move_origin(const Origin& origin);

  /// There is at most one job at a time; its solution is returned through solved().
  [[nodiscard]] std::optional<SolveJob> due_job(Timestamp now);
  Outcome solved(Solution solution, Timestamp now);

  [[nodiscard]] const Registration& registration() const noexcept { return places_.now(); }
  /// Whether that is a provisional one of the running session.
  [[nodiscard]] bool own_provisional() const noexcept { return places_.provisional(); }
  [[nodiscard]] const LastSeen& last_seen() const noexcept { return last_seen_; }
  /// The last sessions, newest first.
  [[nodiscard]] std::vector<SessionStatus> sessions() const;
  [[nodiscard]] std::uint64_t next_session() const noexcept { return next_session_; }
  /// Whether a session is running.
  [[nodiscard]] bool busy() const { return !sessions_.empty() && running(sessions_.front()); }
  /// What is missing for a (better) registration, as sentences for people.
  [[nodiscard]] std::vector<std::string> awaits(Timestamp now) const;

 private:
  /// Conflict while a session is running: `what` cannot be changed then.
  [[nodiscard]] Result<void> unless_busy(const char* what) const;
  void begin(Duration target, bool automatic, Timestamp now);
  void start_by_itself(Timestamp now);
  void end_session(SessionState state);
  void show_progress(SessionStatus& session) const;
  [[nodiscard]] SessionStatus* find_session(std::uint64_t id);
  [[nodiscard]] bool asks_first(const SessionStatus& session) const;
  Outcome propose(Registration next, const Registration& candidate, Timestamp now);
  void drop_proposal(const std::string& reason);
  Outcome settle_provisional(const Registration& candidate);
  Outcome settle_final(const Registration& candidate, Timestamp now);
  Outcome put_into_use(const Registration& candidate, Timestamp now);
  void propose_rest(const Registration& candidate);
  void explain_refusal(const Registration& candidate, const Error& why, bool withdrawn);
  void back_off(const Registration& candidate, Timestamp now);
  [[nodiscard]] std::vector<std::string> shortfalls(const Registration& candidate) const;
  [[nodiscard]] bool waits(const SensorId& sensor, Timestamp now) const;
  [[nodiscard]] std::optional<Duration> retry_in(Timestamp now) const;

  RegistrarConfig config_;
  PlacesInUse places_;
  RegistrationSession session_;
  LastSeen last_seen_;
  std::uint64_t next_session_;
  std::deque<SessionStatus> sessions_;  ///< Newest first; the running one, if any, is at the front.
  bool solving_ = false;
  std::stop_source stop_solve_;
  SolveKind solving_kind_ = SolveKind::Provisional;
  Retries retries_;
};

}  // namespace chorus::core

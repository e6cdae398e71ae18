#include "fusion-server/core/registrar.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fusion-server/core/accuracy.h"
#include "fusion-server/core/adoption.h"
#include "fusion-server/core/awaited.h"
#include "fusion-server/core/closure.h"
#include "fusion-server/core/common_clock.h"

namespace chorus::core {
namespace {

constexpr std::size_t kSessionsKept = 8;

}  // namespace

Registrar::Registrar(RegistrarConfig config, Registration registration, std::uint64_t first_session)
    : config_(std::move(config)),
      places_(std::move(registration)),
      session_(config_.session),
      next_session_(first_session) {}

void Registrar::reconfigure(RegistrarConfig config) {
  const bool same_session = config.session == config_.session;
  config_ = std::move(config);
  if (!same_session && !session_.collecting()) session_ = RegistrationSession(config_.session);
  last_seen_.keep(config_.sensors);
  retries_.keep(config_.sensors);
}

void Registrar::take(const SensorFrame& frame) {
  last_seen_.add(frame);
  session_.add(frame);
}

void Registrar::begin(Duration target, bool automatic, Timestamp now) {
  session_.start(target);
  places_.settle();
  SessionStatus status;
  status.id = next_session_++;
  status.state = SessionState::Collecting;
  status.automatic = automatic;
  status.started = now;
  status.target_radius = config_.session.target_radius;
  sessions_.push_front(std::move(status));
  if (sessions_.size() > kSessionsKept) sessions_.pop_back();
}

Result<std::uint64_t> Registrar::start(Duration target, Timestamp now, Adoption adoption) {
  if (!busy()) {
    begin(target, false, now);
    sessions_.front().adoption = adoption;
    return sessions_.front().id;
  }
  SessionStatus& current = sessions_.front();
  if (!current.automatic) {
    return fail(ErrorCode::Conflict, "registration",
                fmt::format("session {0} is running already: follow /registration/sessions/{0}, or "
                            "cancel it with DELETE (chorus register --cancel)",
                            current.id));
  }
  current.automatic = false;
  current.adoption = adoption;
  session_.retarget(target);
  return current.id;
}

Result<void> Registrar::cancel(std::uint64_t session, Timestamp now) {
  if (!busy() || sessions_.front().id != session)
    return fail(ErrorCode::NotFound, "registration", "this session does not run");
  if (places_.take_back()) {
    sessions_.front().reasons = {"cancelled; its provisional registration was withdrawn"};
  } else {
    sessions_.front().reasons = {"cancelled"};
  }
  end_session(SessionState::Cancelled);
  retries_.cancelled(now);
  return {};
}

void Registrar::end_session(SessionState state) {
  if (!busy()) return;
  SessionStatus& current = sessions_.front();
  show_progress(current);
  current.state = state;
  session_.cancel();
  places_.settle();
  stop_solve_.request_stop();
}

void Registrar::show_progress(SessionStatus& session) const {
  session.elapsed = seconds(session_.elapsed());
  if (!session.reached) session.target = seconds(session_.target());
  session.pairs = session_.coverage().pairs();
  session.cells = session_.coverage().cells(registration());
}

void Registrar::forget() {
  (void)places_.take_back();  // a session's own result is not worth going back to
  end_session(SessionState::Cancelled);
  drop_proposal("given up: the registration it was compared with was forgotten");
  retries_.clear();
  places_.forget();
}

Result<void> Registrar::unless_busy(const char* what) const {
  if (!busy()) return {};
  return fail(ErrorCode::Conflict, what,
              "a registration session is running; wait for its end, or cancel it: chorus register "
              "--cancel");
}

Result<void> Registrar::undo() {
  if (auto idle = unless_busy("registration"); !idle) return pass(idle);
  auto done = places_.undo(config_.sensors);
  if (done) drop_proposal("given up: the registration before was put into use");
  return done;
}

bool Registrar::displace(const SensorId& sensor, const std::string& reason) {
  constexpr std::ptrdiff_t kLeastPlaced = 3;
  const auto placed = std::ranges::count_if(registration().sensors, [&](const auto& entry) {
    return config_.sensors.contains(entry.first);
  });
  if (busy() || placed < kLeastPlaced || !registration().sensors.contains(sensor)) return false;
  retries_.forget(sensor);
  drop_proposal("given up: " + reason);
  places_.displace(sensor, reason);
  return true;
}

Result<void> Registrar::release(const SensorId& sensor) {
  if (auto idle = unless_busy("registration"); !idle) return pass(idle);
  if (!config_.sensors.contains(sensor))
    return fail(ErrorCode::NotFound, "sensors/" + sensor.str(), "this sensor is not followed");
  retries_.forget(sensor);
  if (!registration().sensors.contains(sensor)) return {};
  if (displace(sensor, fmt::format("{} is to be registered anew, as somebody asked", sensor.str())))
    return {};
  return fail(
      ErrorCode::Conflict, "registration",
      "with fewer than three sensors that have a place, a walk registers all of them: start "
      "one");
}

Result<void> Registrar::move_origin(const Origin& origin) {
  if (auto idle = unless_busy("origin"); !idle) return pass(idle);
  return places_.move_origin(origin);
}

Result<void> Registrar::accept() {
  if (auto idle = unless_busy("registration"); !idle) return pass(idle);
  const auto session = places_.accept(config_.sensors);
  if (!session) return pass(session);
  if (SessionStatus* own = find_session(*session)) own->adopted = true;
  for (const auto& [sensor, place] : registration().sensors) retries_.forget(sensor);
  return {};
}

Result<void> Registrar::decline() {
  if (!proposal())
    return fail(ErrorCode::NotFound, "registration", "no registration waits to be accepted");
  drop_proposal("declined; the registration from before stays in use");
  return {};
}

SessionStatus* Registrar::find_session(std::uint64_t id) {
  const auto own = std::ranges::find(sessions_, id, &SessionStatus::id);
  return own == sessions_.end() ? nullptr : &*own;
}

/// Forgets the proposal, and adds `reason` to the session that made it, if that is still listed.
void Registrar::drop_proposal(const std::string& reason) {
  const auto session = places_.drop_proposal();
  if (!session) return;
  if (SessionStatus* own = find_session(*session)) own->reasons.push_back(reason);
}

bool Registrar::asks_first(const SessionStatus& session) const {
  return session.adoption == Adoption::WhenAccepted && !places_.settled().sensors.empty();
}

Outcome Registrar::propose(Registration next, const Registration& candidate, Timestamp now) {
  // A session that began by itself may have adopted something before a client took it over.
  const bool withdrawn = places_.take_back();
  drop_proposal("replaced by another proposal");
  auto changes = place_changes(registration(), next);
  places_.propose({sessions_.front().id, std::move(next), std::move(changes)});
  sessions_.front().adopted = false;
  back_off(candidate, now);
  end_session(SessionState::Done);
  return withdrawn ? Outcome::Withdrawn : Outcome::Nothing;
}

bool Registrar::waits(const SensorId& sensor, Timestamp now) const {
  return !registration().sensors.empty() && retries_.waits(sensor, now);
}

void Registrar::start_by_itself(Timestamp now) {
  if (!config_.session.automatic || busy() || proposal() || now < retries_.not_before()) return;
  const std::set<SensorId> seeing = last_seen_.seeing(now);
  // A single sensor has no partner to be registered with, unless it is the only one there is.
  const bool enough = seeing.size() >= 2 || (seeing.size() == 1 && config_.sensors.size() == 1);
  std::set<SensorId> missing = unplaced(registration(), seeing);
  std::erase_if(missing, [&](const SensorId& sensor) { return waits(sensor, now); });
  if (enough && !missing.empty()) begin(config_.session.target, true, now);
}

std::optional<SolveJob> Registrar::due_job(Timestamp now) {
  if (solving_) {
    // The final solve is due, so a provisional result for a part of the walk is no longer useful.
    if (solving_kind_ == SolveKind::Provisional && session_.final_due()) stop_solve_.request_stop();
    return std::nullopt;
  }
  start_by_itself(now);
  const auto kind = session_.due();
  if (!kind) return std::nullopt;
  solving_ = true;
  solving_kind_ = *kind;
  stop_solve_ = std::stop_source();
  if (*kind == SolveKind::Final) sessions_.front().state = SessionState::Solving;
  SolveJob job{sessions_.front().id, *kind, session_.walk(), config_.registration,
               stop_solve_.get_token()};
  // The world must not jump from solve to solve: the master stays as long as it takes part.
  const SensorId& master = registration().master;
  const bool walks = std::any_of(job.walk.begin(), job.walk.end(),
                                 [&](const SharedTrack& track) { return track.sensor == master; });
  if (!job.config.master && walks && registration().sensors.contains(master)) {
    job.config.master = master;
  }
  return job;
}

std::vector<std::string> Registrar::shortfalls(const Registration& candidate) const {
  std::vector<std::string> reasons = candidate.reasons;
  std::vector<std::string> missing;
  for (const auto& [sensor, place] : registration().sensors) {
    if (!candidate.sensors.contains(sensor)) missing.push_back(sensor.str());
  }
  if (missing.empty()) return reasons;
  const bool one = missing.size() == 1;
  reasons.push_back(
      fmt::format("the registration in use places sensor{} {}, this walk does not; take {} out of "
                  "\"sensors\" if {} gone; chorus register --fresh (DELETE /registration) gives "
                  "all places up",
                  one ? "" : "s", fmt::join(missing, ", "), one ? missing.front() : "them",
                  one ? "it is" : "they are"));
  return reasons;
}

Outcome Registrar::solved(Solution solution, Timestamp now) {
  solving_ = false;
  const bool wanted = busy() && sessions_.front().id == solution.session;
  if (!wanted || solution.given_up) return Outcome::Nothing;
  session_.solved_in(solution.cost);
  note_closure(solution.registration);
  keep_near_ours(solution.registration);
  places_.keep(config_.sensors);
  sessions_.front().verdict = solution.registration.verdict;
  sessions_.front().reasons = solution.registration.reasons;
  sessions_.front().accuracy = accuracy_of(solution.registration);
  return solution.kind == SolveKind::Final ? settle_final(solution.registration, now)
                                           : settle_provisional(solution.registration);
}

Outcome Registrar::settle_provisional(const Registration& candidate) {
  SessionStatus& current = sessions_.front();
  if (!current.reached &&
      accurate_enough(candidate, places_.settled(), config_.session.target_radius)) {
    current.reached = true;
    current.target = seconds(session_.target());
    session_.finish();
  }
  if (asks_first(current)) return Outcome::Nothing;
  auto next = places_.successor(registration(), confirmed_part(candidate), SolveKind::Provisional,
                                current.automatic);
  if (!next) return Outcome::Nothing;
  places_.adopt_provisionally(std::move(*next));
  current.adopted = true;
  return Outcome::Adopted;
}

/// Compares with the registration from before the session; the session's own provisional ones do
/// not count.
Outcome Registrar::settle_final(const Registration& candidate, Timestamp now) {
  const Registration sure = confirmed_part(candidate);
  const bool whole = asks_first(sessions_.front()) || sure.sensors.empty();
  if (whole && !candidate.sensors.empty()) {
    auto next = places_.successor(places_.settled(), candidate, SolveKind::Final,
                                  sessions_.front().automatic);
    if (next) return propose(std::move(*next), candidate, now);
  }
  const Outcome outcome = put_into_use(whole ? candidate : sure, now);
  if (sure.sensors.size() < candidate.sensors.size()) propose_rest(candidate);
  return outcome;
}

Outcome Registrar::put_into_use(const Registration& candidate, Timestamp now) {
  SessionStatus& current = sessions_.front();
  auto next = places_.successor(places_.settled(), candidate, SolveKind::Final, current.automatic);
  current.adopted = next.has_value();
  Outcome outcome = Outcome::Adopted;
  if (next) {
    drop_proposal("replaced by the result of a later session");
    places_.adopt(std::move(*next));
  } else {
    const bool withdrawn = places_.take_back();
    explain_refusal(candidate, next.error(), withdrawn);
    outcome = withdrawn ? Outcome::Withdrawn : Outcome::Nothing;
  }
  places_.note(candidate, !next && next.error().message == kContradicted);
  back_off(candidate, now);
  end_session(SessionState::Done);
  return outcome;
}

/// Proposes the unconfirmed places beside those that are in use by now.
void Registrar::propose_rest(const Registration& candidate) {
  auto next = places_.successor(registration(), candidate, SolveKind::Final, true);
  if (!next) return;
  drop_proposal("replaced by another proposal");
  auto changes = place_changes(registration(), *next);
  places_.propose({sessions_.front().id, std::move(*next), std::move(changes)});
}

void Registrar::explain_refusal(const Registration& candidate, const Error& why, bool withdrawn) {
  SessionStatus& current = sessions_.front();
  const bool none = registration().sensors.empty();
  // An automatic session concerns only the sensors without a place.
  if (current.automatic && !none) current.verdict = Verdict::Refused;
  current.reasons = shortfalls(candidate);
  if (why.code == ErrorCode::Conflict || current.reasons.empty())
    current.reasons.push_back(why.message);
  if (!withdrawn) return;
  current.reasons.push_back(
      std::string("the provisional registration of this session was ") +
      (none ? "withdrawn; there is none now" : "withdrawn; the one from before is in use again"));
}

void Registrar::back_off(const Registration& candidate, Timestamp now) {
  for (const auto& [sensor, own] : candidate.verdicts) {
    if (registration().sensors.contains(sensor))
      retries_.forget(sensor);
    else
      retries_.failed(sensor, now);
  }
}

std::vector<SessionStatus> Registrar::sessions() const {
  std::vector<SessionStatus> all(sessions_.begin(), sessions_.end());
  if (busy()) show_progress(all.front());
  return all;
}

std::vector<std::string> Registrar::awaits(Timestamp now) const {
  const auto all = sessions();
  Situation situation{
      config_.sensors,           registration(), last_seen_, nullptr,
      config_.session.automatic, std::nullopt,   now,        config_.registration.good_position};
  if (busy()) situation.session = &all.front();
  situation.retry = retry_in(now);
  situation.proposes = proposal().has_value();
  return awaited(situation);
}

/// Time until the first unplaced sensor that sees a body may start a session; none: it may start
/// now.
std::optional<Duration> Registrar::retry_in(Timestamp now) const {
  std::optional<Timestamp> first;
  for (const SensorId& sensor : unplaced(registration(), last_seen_.seeing(now))) {
    const Timestamp at = waits(sensor, now) ? *retries_.waits(sensor, now) : now;
    first = std::min(first.value_or(at), at);
  }
  const Timestamp next = std::max(first.value_or(now), retries_.not_before());
  return next > now ? std::optional(next - now) : std::nullopt;
}

}  // namespace chorus::core

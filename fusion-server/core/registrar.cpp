#include "fusion-server/core/registrar.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fusion-server/core/accuracy.h"
#include "fusion-server/core/awaited.h"
#include "fusion-server/core/closure.h"
#include "fusion-server/core/common_clock.h"

namespace chorus::core {
namespace {

constexpr std::size_t kSessionsKept = 8;

}  // namespace

Registrar::Registrar(RegistrarConfig config, Registration registration, std::uint64_t first_session)
    : config_(std::move(config)),
      registration_(std::move(registration)),
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
  before_.reset();
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
  if (take_back()) {
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
  before_.reset();
  stop_solve_.request_stop();
}

void Registrar::show_progress(SessionStatus& session) const {
  session.elapsed = seconds(session_.elapsed());
  if (!session.reached) session.target = seconds(session_.target());
  session.pairs = session_.coverage().pairs();
  session.cells = session_.coverage().cells(registration_);
}

void Registrar::forget() {
  (void)take_back();  // a session's own result is not worth going back to
  end_session(SessionState::Cancelled);
  if (!registration_.sensors.empty()) forgotten_ = anchors_of(registration_);
  drop_proposal("given up: the registration it was compared with was forgotten");
  lacks_displaced_ = false;
  keep_earlier(registration_);
  retries_.clear();
  const std::uint64_t version = registration_.version;
  registration_ = Registration{};
  registration_.version = version;
}

void Registrar::keep_earlier(const Registration& used) {
  if (!used.sensors.empty()) earlier_ = used;
}

Result<void> Registrar::unless_busy(const char* what) const {
  if (!busy()) return {};
  return fail(ErrorCode::Conflict, what,
              "a registration session is running; wait for its end, or cancel it: chorus register "
              "--cancel");
}

Result<void> Registrar::undo() {
  if (auto idle = unless_busy("registration"); !idle) return pass(idle);
  if (!earlier_)
    return fail(ErrorCode::NotFound, "registration", "no registration from before is known");
  Registration back = *earlier_;
  keep_configured(back, config_.sensors);
  if (back.sensors.empty())
    return fail(ErrorCode::NotFound, "registration", "none of its sensors is configured any more");
  drop_proposal("given up: the registration before was put into use");
  earlier_.reset();
  keep_earlier(registration_);
  lacks_displaced_ = false;
  replace(std::move(back));
  return {};
}

bool Registrar::displace(const SensorId& sensor, const std::string& reason) {
  constexpr std::ptrdiff_t kLeastPlaced = 3;
  const auto placed = std::ranges::count_if(registration_.sensors, [&](const auto& entry) {
    return config_.sensors.contains(entry.first);
  });
  if (busy() || placed < kLeastPlaced || !registration_.sensors.contains(sensor)) return false;
  retries_.forget(sensor);
  drop_proposal("given up: " + reason);
  if (!std::exchange(lacks_displaced_, true)) keep_earlier(registration_);
  replace(without(registration_, sensor, reason));
  return true;
}

Result<void> Registrar::move_origin(const Origin& origin) {
  if (auto idle = unless_busy("origin"); !idle) return pass(idle);
  auto next = with_origin(registration_, origin);
  if (!next) return pass(next);
  if (proposal_) {
    if (auto moved = with_origin(proposal_->registration, origin))
      proposal_->registration = std::move(*moved);
  }
  lacks_displaced_ = false;
  keep_earlier(registration_);
  replace(std::move(*next));
  return {};
}

/// After forget(), users of the output still rely on the old world, so a new registration is moved
/// into it.
Result<Registration> Registrar::successor(const Registration& base, const Registration& candidate,
                                          SolveKind kind) const {
  auto next = adopted(base, candidate, kind, sessions_.front().automatic);
  if (!next || !base.sensors.empty()) return next;
  return in_world_of(forgotten_, std::move(*next));
}

bool Registrar::waits(const SensorId& sensor, Timestamp now) const {
  return !registration_.sensors.empty() && retries_.waits(sensor, now);
}

void Registrar::start_by_itself(Timestamp now) {
  if (!config_.session.automatic || busy() || proposal_ || now < retries_.not_before()) return;
  const std::set<SensorId> seeing = last_seen_.seeing(now);
  // A single sensor has no partner to be registered with, unless it is the only one there is.
  const bool enough = seeing.size() >= 2 || (seeing.size() == 1 && config_.sensors.size() == 1);
  std::set<SensorId> missing = unplaced(registration_, seeing);
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
  const SensorId& master = registration_.master;
  const bool walks = std::any_of(job.walk.begin(), job.walk.end(),
                                 [&](const SharedTrack& track) { return track.sensor == master; });
  if (!job.config.master && walks && registration_.sensors.contains(master)) {
    job.config.master = master;
  }
  return job;
}

void Registrar::replace(Registration next) {
  const std::uint64_t version = registration_.version + 1;
  registration_ = std::move(next);
  registration_.version = version;
}

bool Registrar::take_back() {
  if (!before_) return false;
  replace(std::move(*before_));
  before_.reset();
  return true;
}

std::vector<std::string> Registrar::shortfalls(const Registration& candidate) const {
  std::vector<std::string> reasons = candidate.reasons;
  std::vector<std::string> missing;
  for (const auto& [sensor, place] : registration_.sensors) {
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
  // Places of sensors that are no longer configured must not constrain the new registration.
  keep_configured(registration_, config_.sensors);
  if (before_) keep_configured(*before_, config_.sensors);
  sessions_.front().verdict = solution.registration.verdict;
  sessions_.front().reasons = solution.registration.reasons;
  sessions_.front().accuracy = accuracy_of(solution.registration);
  return solution.kind == SolveKind::Final ? settle_final(solution.registration, now)
                                           : settle_provisional(solution.registration);
}

Outcome Registrar::settle_provisional(const Registration& candidate) {
  SessionStatus& current = sessions_.front();
  if (!current.reached && accurate_enough(candidate, before_ ? *before_ : registration_,
                                          config_.session.target_radius)) {
    current.reached = true;
    current.target = seconds(session_.target());
    session_.finish();
  }
  if (asks_first(current)) return Outcome::Nothing;
  auto next = successor(registration_, candidate, SolveKind::Provisional);
  if (!next) return Outcome::Nothing;
  if (!before_) before_ = registration_;
  replace(std::move(*next));
  current.adopted = true;
  return Outcome::Adopted;
}

/// Compares with the registration from before the session; the session's own provisional ones do
/// not count.
Outcome Registrar::settle_final(const Registration& candidate, Timestamp now) {
  SessionStatus& current = sessions_.front();
  auto next = successor(before_ ? *before_ : registration_, candidate, SolveKind::Final);
  if (next && asks_first(current)) return propose(std::move(*next), candidate, now);
  current.adopted = next.has_value();
  Outcome outcome = Outcome::Adopted;
  if (next) {
    drop_proposal("replaced by the result of a later session");
    if (!std::exchange(lacks_displaced_, false)) keep_earlier(before_ ? *before_ : registration_);
    replace(std::move(*next));
  } else {
    const bool withdrawn = take_back();
    explain_refusal(candidate, next.error(), withdrawn);
    if (next.error().message == kContradicted) note_contradiction(registration_);
    outcome = withdrawn ? Outcome::Withdrawn : Outcome::Nothing;
  }
  note_refusals(registration_, candidate);
  back_off(candidate, now);
  end_session(SessionState::Done);
  return outcome;
}

void Registrar::explain_refusal(const Registration& candidate, const Error& why, bool withdrawn) {
  SessionStatus& current = sessions_.front();
  const bool none = registration_.sensors.empty();
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
    if (registration_.sensors.contains(sensor))
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
      config_.sensors,           registration_, last_seen_, nullptr,
      config_.session.automatic, std::nullopt,  now,        config_.registration.good_position};
  if (busy()) situation.session = &all.front();
  situation.retry = retry_in(now);
  situation.proposes = proposal_.has_value();
  return awaited(situation);
}

/// Time until the first unplaced sensor that sees a body may start a session; none: it may start
/// now.
std::optional<Duration> Registrar::retry_in(Timestamp now) const {
  std::optional<Timestamp> first;
  for (const SensorId& sensor : unplaced(registration_, last_seen_.seeing(now))) {
    const Timestamp at = waits(sensor, now) ? *retries_.waits(sensor, now) : now;
    first = std::min(first.value_or(at), at);
  }
  const Timestamp next = std::max(first.value_or(now), retries_.not_before());
  return next > now ? std::optional(next - now) : std::nullopt;
}

}  // namespace chorus::core

#include "fusion-server/core/fusion_core.h"

#include <algorithm>
#include <utility>

namespace chorus::core {
namespace {

// A body seen within this time counts as "somebody is there".
constexpr Duration kSeenLately = std::chrono::seconds(2);

}  // namespace

FusionCore::FusionCore(CoreConfig config, Registration registration)
    : config_(std::move(config)),
      schedule_(config_.output, config_.first_sequence),
      registration_(std::move(registration)),
      session_(config_.session),
      hindsight_(config_.output.late_frames) {}

void FusionCore::reconfigure(CoreConfig config) {
  const bool same_output = config.output == config_.output;
  const bool same_session = config.session == config_.session;
  config_ = std::move(config);
  if (!same_output) schedule_.reconfigure(config_.output);
  if (!same_session && !session_.collecting()) session_ = RegistrationSession(config_.session);
  std::erase_if(histories_,
                [&](const auto& entry) { return !config_.sensors.contains(entry.first); });
  std::erase_if(saw_body_,
                [&](const auto& entry) { return !config_.sensors.contains(entry.first); });
}

void FusionCore::take(const SensorFrame& frame) {
  if (!config_.sensors.contains(frame.sensor)) return;
  const align::PushVerdict verdict = histories_[frame.sensor].push(frame);
  if (verdict == align::PushVerdict::Duplicate) return;
  if (verdict == align::PushVerdict::Backwards || verdict == align::PushVerdict::Future) {
    Refusals& refusals = refused_[frame.sensor];
    ++refusals.count;
    refusals.last = frame.received;
    return;
  }
  if (!frame.bodies.empty()) saw_body_[frame.sensor] = frame.received;
  session_.add(frame);
}

std::optional<Snapshot> FusionCore::tick(Timestamp now) {
  if (idle(now) > Duration{0}) return std::nullopt;
  const Tick tick = schedule_.next(now);
  pipeline::Step step = pipeline::step({tick.instant, now, tick.sequence}, histories_,
                                       registration_, memory_, config_.pipeline);
  Answered answered{
      tick, std::exchange(memory_, std::move(step.memory)), {}, parts_of(step.snapshot)};
  reports_ = step.snapshot.reports;
  for (const SensorReport& report : reports_) {
    const bool spoke = report.basis == Basis::Exact || report.basis == Basis::Interpolated;
    if (!spoke && registration_.sensors.contains(report.sensor))
      answered.without.push_back(report.sensor);
  }
  shares_.answered(step.snapshot, awaited_);
  if (answered.without.empty()) shares_.settled(answered.parts);
  awaited_.clear();
  hindsight_.remember(std::move(answered));
  schedule_.answered(now);
  return std::move(step.snapshot);
}

std::optional<Snapshot> FusionCore::amended(Timestamp now) {
  const auto answered = hindsight_.due(now);
  if (!answered) return std::nullopt;
  if (!improves(*answered, now)) {
    shares_.settled(answered->parts);
    return std::nullopt;
  }
  const Tick& tick = answered->tick;
  pipeline::Step step = pipeline::step({tick.instant, now, tick.sequence}, histories_,
                                       registration_, answered->before, config_.pipeline);
  shares_.settled(parts_of(step.snapshot));
  return std::move(step.snapshot);
}

bool FusionCore::improves(const Answered& answered, Timestamp now) const {
  return std::any_of(answered.without.begin(), answered.without.end(), [&](const SensorId& sensor) {
    const auto history = histories_.find(sensor);
    if (history == histories_.end()) return false;
    const Basis basis =
        align::basis_at(answered.tick.instant, now, history->second, config_.pipeline.align);
    return basis == Basis::Exact || basis == Basis::Interpolated;
  });
}

Duration FusionCore::idle(Timestamp now) {
  const Tick tick = schedule_.next(now);
  auto awaited = pipeline::awaited({tick.instant, now, tick.sequence}, histories_, registration_,
                                   config_.pipeline);
  const bool ready = awaited.empty();
  if (!ready && now > tick.instant) awaited_ = std::move(awaited);
  return schedule_.wait(now, ready);
}

Result<void> FusionCore::start_session(Duration target) {
  if (session_.collecting()) {
    return fail(ErrorCode::Conflict, "registration",
                "a session is running already; DELETE /registration cancels it");
  }
  session_.start(target);
  ++session_number_;
  session_reasons_.clear();
  return {};
}

void FusionCore::forget() {
  session_.cancel();
  ++session_number_;
  session_reasons_.clear();
  const std::uint64_t version = registration_.version;
  registration_ = Registration{};
  registration_.version = version;
  memory_.tracks.people.clear();  // the ids go on
  memory_.sides.clear();
  hindsight_.forget();
}

void FusionCore::start_by_itself(Timestamp now) {
  if (!config_.session.automatic || session_.collecting()) return;
  std::set<SensorId> seeing;
  for (const auto& [sensor, when] : saw_body_) {
    if (now - when <= kSeenLately) seeing.insert(sensor);
  }
  // One sensor alone has nobody to be registered with, unless it is the only one there is.
  const bool enough = seeing.size() >= 2 || (seeing.size() == 1 && config_.sensors.size() == 1);
  if (!enough || unplaced(registration_, seeing).empty()) return;
  auto reasons = std::move(session_reasons_);  // why the last one failed stays readable meanwhile
  if (start_session(config_.session.target)) session_reasons_ = std::move(reasons);
}

std::optional<SolveJob> FusionCore::due_job(Timestamp now) {
  if (solving_) return std::nullopt;
  start_by_itself(now);
  const auto kind = session_.due();
  if (!kind) return std::nullopt;
  solving_ = true;
  SolveJob job{session_number_, *kind, session_.walk(), config_.registration};
  // The world must not jump from solve to solve: the master stays while it takes part.
  const SensorId& master = registration_.master;
  const bool walks = std::any_of(job.walk.begin(), job.walk.end(),
                                 [&](const auto& track) { return track.sensor == master; });
  if (!job.config.master && walks && registration_.sensors.contains(master)) {
    job.config.master = master;
  }
  return job;
}

std::vector<std::string> FusionCore::shortfalls(const Registration& candidate) const {
  std::vector<std::string> reasons = candidate.reasons;
  for (const auto& [sensor, place] : registration_.sensors) {
    if (!candidate.sensors.contains(sensor)) {
      reasons.push_back("the registration in use places sensor " + sensor.str() +
                        ", this walk does not; DELETE /registration first to give it up");
    }
  }
  return reasons;
}

bool FusionCore::solved(Solution solution) {
  solving_ = false;
  if (solution.session != session_number_) return false;  // cancelled meanwhile
  if (solution.kind == SolveKind::Final) session_.release();
  // Places of sensors that are no longer configured do not bind the new registration.
  std::erase_if(registration_.sensors,
                [&](const auto& entry) { return !config_.sensors.contains(entry.first); });
  if (!should_adopt(registration_, solution.registration, solution.kind)) {
    session_reasons_ = shortfalls(solution.registration);
    return false;
  }
  session_reasons_.clear();
  const std::uint64_t version = registration_.version + 1;
  hindsight_.forget();  // what was answered stands in another world
  registration_ = std::move(solution.registration);
  registration_.version = version;
  return true;
}

SessionStatus FusionCore::session() const {
  SessionStatus status;
  status.collecting = session_.collecting();
  status.elapsed = seconds(session_.elapsed());
  status.target = seconds(session_.target());
  status.reasons = session_reasons_;
  return status;
}

std::uint64_t FusionCore::refused(const SensorId& sensor) const {
  const auto it = refused_.find(sensor);
  return it == refused_.end() ? 0 : it->second.count;
}

bool FusionCore::refuses(const SensorId& sensor, Timestamp now) const {
  const auto it = refused_.find(sensor);
  return it != refused_.end() && now - it->second.last < kSeenLately;
}

}  // namespace chorus::core

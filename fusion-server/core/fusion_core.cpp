#include "fusion-server/core/fusion_core.h"

#include <algorithm>
#include <utility>

#include "fusion-server/associate/recognition.h"
#include "fusion-server/core/world.h"

namespace chorus::core {
namespace {

RegistrarConfig registrar_config(const CoreConfig& config) {
  return {config.registration, config.session, config.sensors};
}

CoreConfig with_polled(CoreConfig config) {
  config.pipeline.polled = config.sensors;
  return config;
}

constexpr std::string_view kFrozen =
    "a body is left out: its coordinates are repeated to the last digit under new stamps";

/// True if some sensor has nearly the same place in both registrations: then they use the same
/// world, and people can be matched.
bool share_a_place(const Registration& one, const Registration& other) {
  constexpr double kSamePlace = 0.3;  // [m]
  const Eigen::Vector3d mark = kReach * Eigen::Vector3d::UnitZ();
  return std::ranges::any_of(one.sensors, [&](const auto& entry) {
    const auto found = other.sensors.find(entry.first);
    return found != other.sensors.end() &&
           (entry.second.world_from_sensor * mark - found->second.world_from_sensor * mark).norm() <
               kSamePlace;
  });
}

std::vector<PersonId> ids_of(const Snapshot& snapshot) {
  std::vector<PersonId> ids;
  for (const FusedBody& body : snapshot.bodies) ids.push_back(body.id);
  return ids;
}

/// True if all of `ids` are among the people.
bool shows(const std::vector<Person>& people, const std::vector<PersonId>& ids) {
  return std::ranges::all_of(
      ids, [&](PersonId id) { return std::ranges::find(people, id, &Person::id) != people.end(); });
}

}  // namespace

FusionCore::FusionCore(CoreConfig config, Registration registration)
    : config_(with_polled(std::move(config))),
      schedule_(config_.output, config_.first_sequence),
      registrar_(registrar_config(config_), std::move(registration), config_.first_session),
      world_(config_.output.late_frames) {
  memory_.tracks.next_id = config_.first_person;
  wear_.configure(config_.worn, config_.inertial);
}

void FusionCore::reconfigure(CoreConfig config) {
  const bool same_output = config.output == config_.output;
  config_ = with_polled(std::move(config));
  if (!same_output) schedule_.reconfigure(config_.output);
  registrar_.reconfigure(registrar_config(config_));
  const auto gone = [&](const auto& entry) { return !config_.sensors.contains(entry.first); };
  std::erase_if(histories_, gone);
  std::erase_if(sensors_, gone);
  guard_.keep(config_.sensors);
  strays_.keep(config_.sensors);
  wear_.configure(config_.worn, config_.inertial);
  world_.pending.sequence = 0;
}

void FusionCore::take(SensorFrame frame) {
  if (!config_.sensors.contains(frame.sensor)) return;
  sift(frame);
  if (!histories_.contains(frame.sensor))
    world_.pending.sequence = 0;  // one more sensor to wait for
  const align::PushVerdict verdict = histories_[frame.sensor].push(in_step(frame));
  if (sensors_[frame.sensor].losses.count(frame, verdict)) registrar_.take(frame);
}

/// The frame with its capture time by the common clock, as far as a walk has determined that;
/// earlier frames of its sensor are moved to the same clock.  Sessions collect frames uncorrected,
/// because a solve finds the whole offset.
SensorFrame FusionCore::in_step(SensorFrame frame) {
  ClockCorrection& clock = sensors_[frame.sensor].clock;
  histories_[frame.sensor].move_in_time(clock.take(frame, registration()));
  move_in_time(frame, clock.added());
  return frame;
}

/// Removes bodies that cannot be a person's, or that are frozen; the frame's other bodies stay.
void FusionCore::sift(SensorFrame& frame) {
  const associate::BodyLimits& limits = config_.pipeline.association.bodies;
  std::string_view why;
  std::erase_if(frame.bodies, [&](const BodyFrame& body) {
    const std::string_view reason = associate::implausible(body.skeleton, limits);
    if (!reason.empty()) why = reason;
    return !reason.empty();
  });
  SensorMemory& own = sensors_[frame.sensor];
  if (own.frozen.remove_from(frame, limits) > 0) why = kFrozen;
  if (!why.empty()) own.losses.refuse(frame, why);
}

std::optional<Snapshot> FusionCore::tick(Timestamp now) {
  if (idle(now) > Duration{0}) return std::nullopt;
  const Tick tick = schedule_.next(now);
  pipeline::Step step = step_at(tick, now);
  Answered answered{tick,
                    std::exchange(memory_, std::move(step.memory)),
                    {},
                    parts_of(step.snapshot),
                    ids_of(step.snapshot),
                    world_.pending.awaited.extension};
  told_.reports = step.snapshot.reports;
  for (const SensorReport& report : told_.reports) {
    const bool spoke = report.basis == Basis::Exact || report.basis == Basis::Interpolated;
    if (!spoke && registration().sensors.contains(report.sensor))
      answered.without.push_back(report.sensor);
  }
  note_shares(step.snapshot, world_.pending.still, sensors_);
  if (answered.without.empty()) note_settled(answered.parts, sensors_);
  world_.pending.still.clear();
  world_.hindsight.remember(std::move(answered));
  schedule_.answered(now);
  guard_.look(step.people, tick.instant, config_.watch);
  strays_.look({tick.instant, step.snapshot.reports, step.people, step.standings, registration()});
  contests_.look(tick.instant, step.standings);
  displace_moved(tick.instant);
  return std::move(step.snapshot);
}

/// Fuses one instant; after a change of places also with the old places, so that bodies move
/// gradually from the old to the new positions.
pipeline::Step FusionCore::step_at(const Tick& tick, Timestamp now) {
  const pipeline::Inputs in{tick.instant, now, tick.sequence, wear_.say(tick.instant)};
  auto seen = pipeline::perceive(in, histories_, registration(), memory_, config_.pipeline);
  smooth(in, seen);
  pipeline::Step step =
      pipeline::fuse(std::move(seen), in, pipeline::taking_part(registration(), config_.pipeline),
                     config_.pipeline);
  wear_.learn(step.snapshot.bodies, tick.instant);
  if (world_.replaced) {
    auto was = pipeline::step(in, histories_, *world_.replaced, memory_, config_.pipeline).snapshot;
    fade_.apply(was.bodies, tick.instant);
    fade_.begin(was.bodies, step.snapshot.bodies, tick.instant);
    world_.replaced.reset();
  }
  fade_.apply(step.snapshot.bodies, tick.instant);
  return step;
}

void FusionCore::smooth(const pipeline::Inputs& in, const pipeline::Perceived& seen) {
  const pipeline::PipelineConfig& config = config_.pipeline;
  if (!config.smoothing.live) return;
  auto now = pipeline::perception_of(in, pipeline::taking_part(registration(), config), seen);
  for (pipeline::Step& step : world_.smoother.take(std::move(now), config)) {
    fade_.apply(step.snapshot.bodies, step.snapshot.instant);
    told_.smoothed.push_back(std::move(step.snapshot));
  }
}

/// A sensor that was moved has no place from the next instant on, until it is registered again.  If
/// it soon raises another alarm, registering it once more would not help: the alarm stays, and
/// people decide.
void FusionCore::displace_moved(Timestamp instant) {
  constexpr Duration kAgain = std::chrono::minutes(30);
  const auto moved = guard_.moved();
  if (!moved) return;
  std::optional<Timestamp>& last = sensors_[*moved].displaced;
  if (last && instant - *last < kAgain) return;
  Registration before = registration();
  if (!registrar_.displace(*moved, reason_of(*moved, *guard_.alarm_of(*moved)))) return;
  guard_.displaced(*moved);
  memory_.tracks.fields.erase(*moved);  // what hides the view belongs to the old place
  strays_.forget();
  last = instant;
  change_places(std::move(before));
}

Result<void> FusionCore::register_anew(const SensorId& sensor) {
  Registration before = registration();
  if (auto released = registrar_.release(sensor); !released) return released;
  if (!before.sensors.contains(sensor)) return {};
  guard_.released();
  memory_.tracks.fields.erase(sensor);
  strays_.forget();
  change_places(std::move(before));
  return {};
}

std::optional<Snapshot> FusionCore::amended(Timestamp now) {
  const auto answered = world_.hindsight.due(now);
  if (!answered) return std::nullopt;
  if (!improves(*answered, now)) {
    note_settled(answered->parts, sensors_);
    return std::nullopt;
  }
  const Tick& tick = answered->tick;
  const pipeline::Inputs in{tick.instant, now, tick.sequence, wear_.say(tick.instant)};
  const pipeline::PipelineConfig& config = config_.pipeline;
  auto seen = pipeline::perceive(in, histories_, registration(), answered->before, config);
  // Whether somebody is published is asked with the late frames, too, but decided once: a client
  // that looks back must not miss whom it was told of.
  if (!shows(seen.people, answered->people)) {
    note_settled(answered->parts, sensors_);
    return std::nullopt;
  }
  const auto sensors = pipeline::taking_part(registration(), config);
  if (config.smoothing.live) world_.smoother.amend(pipeline::perception_of(in, sensors, seen));
  pipeline::Step step = pipeline::fuse(std::move(seen), in, sensors, config);
  note_settled(parts_of(step.snapshot), sensors_);
  fade_.apply(step.snapshot.bodies, tick.instant);
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

/// Called whenever a frame arrives; the sensors to wait for are computed once per instant.
Duration FusionCore::idle(Timestamp now) {
  const Tick tick = schedule_.next(now);
  PendingInstant& pending = world_.pending;
  if (pending.sequence != tick.sequence) {
    pending.awaited = pipeline::all_awaited(histories_, registration(), config_.pipeline);
    pending.sequence = tick.sequence;
    schedule_.extend(pending.awaited.extension);
  }
  std::vector<pipeline::Awaited>& sensors = pending.awaited.sensors;
  pipeline::drop_settled(sensors, {tick.instant, now, tick.sequence}, histories_);
  if (!sensors.empty() && now > tick.instant) {
    pending.still.clear();
    for (const pipeline::Awaited& one : sensors) pending.still.push_back(one.sensor);
  }
  return schedule_.wait(now, sensors.empty());
}

void FusionCore::forget() {
  const Registration before = registration();
  registrar_.forget();
  note_places(before);
  leave_world();
}

Result<void> FusionCore::move_origin(const Origin& origin) {
  const Registration before = registration();
  auto done = registrar_.move_origin(origin);
  if (!done) return done;
  note_places(before);
  leave_world();
  return done;
}

Result<void> FusionCore::undo() {
  Registration before = registration();
  auto done = registrar_.undo();
  if (!done) return done;
  note_places(before);
  if (!share_a_place(before, registration())) {
    leave_world();
    return done;
  }
  change_places(std::move(before));
  return done;
}

Result<void> FusionCore::accept() {
  Registration before = registration();
  auto done = registrar_.accept();
  if (!done) return done;
  note_places(before);
  change_places(std::move(before));
  return done;
}

/// Called whenever the registration in use has become another one.
void FusionCore::note_places(const Registration& before) {
  guard_.replaced(before, registration());
  strays_.forget();
}

/// After a change of places in the same world: what was decided by the old ones is given up, and
/// bodies fade from there.
void FusionCore::change_places(Registration before) {
  world_ = DecidedWorld(config_.output.late_frames);
  if (!before.sensors.empty()) world_.replaced = std::move(before);
}

void FusionCore::forget(PersonId person) {
  associate::forget(person, memory_.tracks);
  pipeline::forget(person, memory_);
  memory_.seating.leave(person);
  world_.hindsight.forget();  // earlier answers are not given again with this person
  world_.smoother = {};
}

/// Forgets what is remembered about people, because it is in coordinates of the old world.
void FusionCore::leave_world() {
  memory_.tracks.people.clear();  // ids continue to count
  memory_.tracks.mirrors.clear();
  memory_.tracks.floor_seen = false;
  memory_.sides.people.clear();  // what was learned about each sensor stays
  contests_.forget();
  memory_.seating = {};  // nobody left: whoever is here gets the low slots again
  world_ = DecidedWorld(config_.output.late_frames);
  fade_.stop();
  wear_.leave_world();
}

Outcome FusionCore::solved(Solution solution, Timestamp now) {
  Registration before = registration();
  const Outcome outcome = registrar_.solved(std::move(solution), now);
  if (outcome == Outcome::Nothing) return outcome;
  note_places(before);
  change_places(std::move(before));
  return outcome;
}

const SensorMemory& FusionCore::memory_of(const SensorId& sensor) const {
  static const SensorMemory kUnknown;
  const auto own = sensors_.find(sensor);
  return own == sensors_.end() ? kUnknown : own->second;
}

RegistrationProgress FusionCore::progress(Timestamp now) const {
  RegistrationProgress progress;
  progress.sessions = registrar_.sessions();
  progress.next_session = registrar_.next_session();
  progress.earlier = earlier();
  progress.proposal = registrar_.proposal();
  progress.awaits = registrar_.awaits(now);
  progress.own_provisional = registrar_.own_provisional();
  for (const auto& [sensor, place] : registration().sensors) {
    if (!config_.sensors.contains(sensor)) progress.unpolled.push_back(sensor);
  }
  for (const SensorId& sensor : config_.sensors) {
    const auto told = guard_.alarm_of(sensor);
    const bool twice = told && told->or_else && *told->or_else < sensor;
    if (told ? !twice : is_stray(sensor)) progress.alarms.push_back(alarm_text(sensor, now));
  }
  return progress;
}

std::string FusionCore::alarm_text(const SensorId& sensor, Timestamp now) const {
  const auto told = guard_.alarm_of(sensor);
  const bool anew = config_.session.automatic && !registration().sensors.contains(sensor);
  if (told) return sentence_of(sensor, *told, now, anew);
  return is_stray(sensor) ? stray_sentence(sensor, *strays_.since(sensor), now) : std::string();
}

/// While a session runs, it says itself what it waits for.
bool FusionCore::is_stray(const SensorId& sensor) const {
  return !registrar_.busy() && strays_.since(sensor);
}

}  // namespace chorus::core

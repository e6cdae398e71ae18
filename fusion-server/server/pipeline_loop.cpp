#include "fusion-server/server/pipeline_loop.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/units.h"
#include "fusion-server/server/solver.h"
#include "fusion-server/wire/registration_nodes.h"

namespace chorus::server {
namespace {

constexpr std::size_t kMaxFrames = 4096;        // Two seconds of 64 sensors at 30 Hz.
constexpr std::size_t kMaxOrientations = 4096;  // The same of inertial sources.
// Limit of the waiting commands: clients send commands on people's request, not with every frame.
constexpr std::size_t kMaxCommands = 256;
constexpr Duration kMaxIdle = std::chrono::milliseconds(20);
/// How long frames are collected before this thread takes them, per sensor: 64 sensors would wake
/// it for each of 1 920 frames a second; six may have each of their frames taken as it arrives.
constexpr Duration kGatheringPerSensor = std::chrono::microseconds(30);
constexpr Duration kMaxGathering = std::chrono::milliseconds(2);
constexpr Duration kStatusInterval = std::chrono::milliseconds(200);
/// Pause after a failure, which may happen again at once in every iteration.
constexpr Duration kAfterFailure = std::chrono::milliseconds(10);
constexpr Duration kStale = std::chrono::milliseconds(1500);

/// Upper bounds [s]: around one frame interval, around the alignment delay, and values that should
/// never occur.
const std::vector<double> kAgeBounds{0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.15, 0.2, 0.5};

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

std::string_view name_of(core::SolveKind kind) {
  return kind == core::SolveKind::Final ? "final" : "provisional";
}

Duration gathering_of(const core::CoreConfig& config) {
  return std::min<Duration>(static_cast<long>(config.sensors.size()) * kGatheringPerSensor,
                            kMaxGathering);
}

/// Why the newest frame of a connected sensor is so old.  That the clock of its host is wrong is
/// said only where that host does not tell its time.
std::string stale(const SensorStatus& sensor) {
  const std::string clock =
      sensor.clock_offset ? "" : ", or the clock of its host differs from ours by so much";
  if (sensor.rate_hz > 0.0)
    return fmt::format(
        "its frames come, but late: the newest was captured {:.1f} s ago. Its device is slow (of a "
        "camera, GET /camera there shows how long the runner takes){}",
        seconds(*sensor.age), clock);
  return fmt::format(
      "no frame comes at present: the newest was captured {:.1f} s ago. Its device stands still, "
      "or takes seconds for a frame (GET /healthz there){}",
      seconds(*sensor.age), clock);
}

}  // namespace

PipelineLoop::PipelineLoop(LoopOptions options)
    : options_(std::move(options)),
      core_(options_.core, options_.registration),
      frames_(kMaxFrames),
      orientations_(kMaxOrientations),
      commands_(kMaxCommands),
      solutions_(1),
      age_(kAgeBounds),
      gathering_(gathering_of(options_.core)),
      keeper_(options_.store, options_.store_trouble, options_.store_damage) {
  if (auto earlier = options_.store.load_earlier()) core_.set_earlier(std::move(*earlier));
}

PipelineLoop::~PipelineLoop() {
  thread_.request_stop();
  frames_.close();
}

void PipelineLoop::start() {
  keeper_.people(worker_, core_.next_person());
  publish_status(options_.clock->now());
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void PipelineLoop::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    try {
      turn();
    } catch (const std::exception& thrown) {
      ++counters_.steps_failed;
      trouble_.hit(thrown.what());
      std::this_thread::sleep_for(kAfterFailure);
    }
  }
}

void PipelineLoop::turn() {
  gather(std::min(core_.idle(options_.clock->now()), kMaxIdle));
  for (Command& command : commands_.take(Duration{0})) obey(std::move(command));
  take_solutions();
  const auto begun = std::chrono::steady_clock::now();
  const Timestamp now = options_.clock->now();
  if (auto snapshot = core_.tick(now)) {
    publish(std::move(*snapshot));
    counters_.step_seconds += seconds(std::chrono::steady_clock::now() - begun);
    note_displaced();
  }
  if (const auto amended = core_.amended(now)) options_.on_amended(*amended);
  for (const Snapshot& smoothed : core_.smoothed()) options_.on_amended(smoothed);
  if (auto job = core_.due_job(now)) solve(std::move(*job));
  if (now - status_at_ >= kStatusInterval || now < status_at_) publish_status(now);
}

/// Takes the frames that have arrived, or waits for the first.
void PipelineLoop::gather(Duration idle) {
  const auto since = std::chrono::steady_clock::now() - gathered_at_;
  if (since < gathering_) {
    const Duration pause = std::min<Duration>(gathering_ - since, idle);
    std::this_thread::sleep_for(pause);
    idle -= pause;
  }
  std::vector<SensorFrame> frames = frames_.take(idle);
  if (!frames.empty()) gathered_at_ = std::chrono::steady_clock::now();
  // Instants wait for views, not for inertial sensors: what has come until now is taken.
  for (auto& frame : orientations_.take(Duration{0})) core_.take(std::move(frame));
  for (SensorFrame& frame : frames) core_.take(std::move(frame));
}

void PipelineLoop::obey(Command command) {
  if (const auto* start = std::get_if<StartSession>(&command)) {
    start_session(*start);
  } else if (const auto* cancel = std::get_if<CancelSession>(&command)) {
    cancel_session(*cancel);
  } else if (const auto* wish = std::get_if<Forget>(&command)) {
    forget(*wish);
  } else if (const auto* move = std::get_if<MoveOrigin>(&command)) {
    move_origin(*move);
  } else if (const auto* again = std::get_if<RegisterAnew>(&command)) {
    register_anew(*again);
  } else if (const auto* back = std::get_if<Undo>(&command)) {
    undo(*back);
  } else if (const auto* choice = std::get_if<Decide>(&command)) {
    decide(*choice);
  } else if (const auto* left = std::get_if<ForgetPerson>(&command)) {
    core_.forget(left->person);
    log::info("person forgotten", {{"person", left->person.value}});
  } else {
    auto& config = std::get<core::CoreConfig>(command);
    gathering_ = gathering_of(config);
    core_.reconfigure(std::move(config));
  }
  publish_status(options_.clock->now());
}

void PipelineLoop::start_session(const StartSession& wish) {
  obeyed_ = wish.ticket;
  const Timestamp now = options_.clock->now();
  const auto progress = core_.progress(now);
  // The client was told the id `wish.session`: that of an automatic session that was running, which
  // is to become the client's, or of a new one.  If that automatic session has ended meanwhile, no
  // other one is started.
  const bool over =
      wish.session < progress.next_session &&
      !(running(progress.sessions.front()) && progress.sessions.front().id == wish.session);
  if (over) return;
  if (const auto started = core_.start_session(wish.target, now, wish.adoption)) {
    log::info("registration session started",
              {{"session", *started}, {"seconds", seconds(wish.target)}});
  }
}

void PipelineLoop::cancel_session(const CancelSession& wish) {
  obeyed_ = wish.ticket;
  if (!core_.cancel_session(wish.session, options_.clock->now())) return;
  log::info("registration session cancelled", {{"session", wish.session}});
}

void PipelineLoop::forget(const Forget& wish) {
  obeyed_ = wish.ticket;
  core_.forget();
  log::info("registration forgotten");
  keeper_.forget(worker_);
}

void PipelineLoop::move_origin(const MoveOrigin& wish) {
  obeyed_ = wish.ticket;
  if (const auto moved = core_.move_origin(wish.origin); !moved) {
    log::warn("origin not moved", {{"reason", to_string(moved.error())}});
    return;
  }
  log::info("origin moved", {{"x", wish.origin.x},
                             {"z", wish.origin.z},
                             {"yaw_deg", to_deg(wish.origin.yaw)},
                             {"version", core_.registration().version}});
  keeper_.keep(worker_, core_.registration(), core_.earlier());
}

void PipelineLoop::register_anew(const RegisterAnew& wish) {
  obeyed_ = wish.ticket;
  if (const auto done = core_.register_anew(wish.sensor); !done) {
    log::warn("sensor not registered anew", {{"reason", to_string(done.error())}});
    return;
  }
  log::info("sensor is to be registered anew", {{"sensor", wish.sensor.str()}});
  keeper_.keep(worker_, core_.registration(), core_.earlier());
}

void PipelineLoop::undo(const Undo& wish) {
  obeyed_ = wish.ticket;
  if (const auto undone = core_.undo(); !undone) {
    log::warn("registration not undone", {{"reason", to_string(undone.error())}});
    return;
  }
  log::info("registration undone", {{"version", core_.registration().version}});
  keeper_.keep(worker_, core_.registration(), core_.earlier());
}

void PipelineLoop::decide(const Decide& wish) {
  obeyed_ = wish.ticket;
  const auto done = wish.accept ? core_.accept() : core_.decline();
  if (!done) {
    log::warn("proposed registration not decided", {{"reason", to_string(done.error())}});
    return;
  }
  log::info(wish.accept ? "proposed registration accepted" : "proposed registration declined",
            {{"version", core_.registration().version}});
  if (wish.accept) keeper_.keep(worker_, core_.registration(), core_.earlier());
}

void PipelineLoop::publish(Snapshot snapshot) {
  options_.complete(snapshot);
  const auto shared = std::make_shared<const Snapshot>(std::move(snapshot));
  for (Sink* sink : options_.sinks) sink->publish(shared);
  ++counters_.ticks;
  age_.observe(seconds(options_.clock->now() - shared->instant));
}

void PipelineLoop::solve(core::SolveJob job) {
  log::debug("registration solving", {{"solve", name_of(job.kind)}, {"sensors", job.walk.size()}});
  worker_.post(
      [this, job = std::move(job)] { solutions_.give(server::solve(job, options_.clock->now())); });
}

void PipelineLoop::take_solutions() {
  for (core::Solution& solution : solutions_.take(Duration{0})) {
    const core::SolveKind kind = solution.kind;
    const Timestamp moment = options_.clock->now();
    const core::Outcome outcome = core_.solved(std::move(solution), moment);
    const Registration& now = core_.registration();
    const auto progress = core_.progress(moment);
    const auto& sessions = progress.sessions;
    if (outcome == core::Outcome::Adopted) {
      log::info("registration adopted", {{"version", now.version},
                                         {"solve", name_of(kind)},
                                         {"verdict", wire::name_of(now.verdict)},
                                         {"sensors", now.sensors.size()},
                                         {"reasons", joined(now.reasons)}});
    } else if (progress.proposal && progress.proposal->session == sessions.front().id) {
      log::info("registration proposed", {{"session", progress.proposal->session}});
    } else if (kind == core::SolveKind::Final && !sessions.empty()) {
      log::warn(outcome == core::Outcome::Withdrawn ? "registration withdrawn"
                                                    : "registration not adopted",
                {{"reasons", joined(sessions.front().reasons)}});
    }
    // A session's result that was adopted before its end is withdrawn if the final solve is
    // refused, so only the final one is kept.
    if (outcome == core::Outcome::Adopted && kind == core::SolveKind::Final)
      keeper_.keep(worker_, now, core_.earlier());
    publish_status(moment);
  }
}

/// What following the sensor tells: its counts, its clock, and what became of its frames.
void PipelineLoop::add_following(const client::FollowReport& report, Timestamp now,
                                 SensorStatus& status) const {
  const core::SensorMemory& memory = core_.memory_of(report.service.id);
  status.last_error = report.last_error;
  if (status.last_error.empty()) status.last_error = memory.losses.complaint(now);
  status.streaming = report.streaming;
  status.rate_hz = report.rate_hz;
  status.frames = report.frames;
  status.missed = report.missed;
  status.failures = report.failures;
  status.fates = memory.losses.counts();
  status.fates.early += report.early;
  status.fates.stale += report.stale;
  status.refused = refused(status.fates);
  if (report.clock) {
    status.clock_offset = report.clock->ours_minus_theirs;
    status.clock_uncertainty = report.clock->uncertainty;
    status.clock_corrected = correction(report.clock) != Duration{0};
  }
  const auto& walked = memory.clock.walked();
  if (walked && walked->added != Duration{0}) {
    status.walked_offset = walked->added;
    status.walked_sigma = walked->sigma;
    status.guessed_from_age = core_.registration().clocks.size() == 1;
  }
}

SensorStatus PipelineLoop::status_of(const client::FollowReport& report, Timestamp now) const {
  SensorStatus status;
  status.id = report.service.id;
  status.url = report.service.url;
  const core::SensorMemory& memory = core_.memory_of(report.service.id);
  if (report.newest) status.age = now - *report.newest - memory.clock.added();
  const bool silent =
      report.state == client::SensorState::Live && status.age && *status.age > kStale;
  status.state = client::name_of(silent ? client::SensorState::Lost : report.state);
  add_following(report, now, status);
  if (status.last_error.empty() && silent) status.last_error = stale(status);
  const bool lost = silent || report.state == client::SensorState::Lost;
  const core::Share share = lost ? core::Share{} : memory.share;
  status.share = share.in_time;
  status.share_afterwards = share.afterwards;
  status.awaited = share.awaited;
  const auto latency = core_.registration().latencies.find(report.service.id);
  if (latency != core_.registration().latencies.end()) status.latency = latency->second;
  status.host = report.host;
  const auto& reports = core_.reports();
  const auto own = std::find_if(reports.begin(), reports.end(), [&](const SensorReport& r) {
    return r.sensor == report.service.id;
  });
  if (own != reports.end() && core_.uses_weights()) status.weight = own->weight;
  status.bodies = core_.bodies(report.service.id, now);
  status.shift = core_.guard().shift_of(report.service.id);
  status.alarm = core_.alarm_text(report.service.id, now);
  status.contested = core_.contested(report.service.id);
  status.contests = core_.contests(report.service.id);
  return status;
}

/// Stores and logs that a sensor has lost its place.
void PipelineLoop::note_displaced() {
  if (core_.displaced() == displaced_) return;
  displaced_ = core_.displaced();
  for (const std::string& alarm : core_.progress(options_.clock->now()).alarms)
    log::warn("sensor was moved", {{"what", alarm}});
  keeper_.keep(worker_, core_.registration(), core_.earlier());
}

/// Logs once what the pipeline refuses from a live sensor; the poller logs other errors.
void PipelineLoop::complain(const SensorStatus& sensor) {
  std::string& told = told_[sensor.id];
  const bool news = sensor.state == "live" && !sensor.last_error.empty();
  if (news && sensor.last_error != told) {
    log::warn("sensor sends what is left out",
              {{"sensor", sensor.id.str()}, {"reason", sensor.last_error}});
  }
  if (news) told = sensor.last_error;
}

/// Logs who wears a source and which of its sensors slipped, once each.
void PipelineLoop::tell_of_worn(const std::vector<WornReport>& worn) {
  for (const WornReport& source : worn) {
    std::string news;
    if (source.wearer) news = fmt::format("is worn by person {}", source.wearer->value);
    for (const WornSensorReport& one : source.sensors)
      if (one.slipped_ago)
        news += fmt::format("; the sensor of the {} has turned on it by {:.0f} degrees",
                            inertial::words_for(one.limb), to_deg(one.slip));
    std::string& told = told_worn_[source.source];
    if (!news.empty() && news != told)
      log::info("inertial source", {{"source", source.source.str()}, {"what", news}});
    told = std::move(news);
  }
}

void PipelineLoop::publish_status(Timestamp now) {
  status_at_ = now;
  keeper_.people(worker_, core_.next_person());
  Status status;
  for (const client::FollowReport& report : options_.poll_reports()) {
    status.sensors.push_back(status_of(report, now));
    complain(status.sensors.back());
  }
  status.worn = core_.worn(now);
  tell_of_worn(status.worn);
  status.registration = core_.registration();
  status.progress = core_.progress(now);
  status.progress.storage = keeper_.status();
  status.progress.commands = obeyed_;
  status.counters = counters_;
  status.counters.age = age_.snapshot();
  status.counters.jobs_failed = worker_.failed();
  status.counters.displaced = core_.displaced();
  status.counters.ticks_skipped = core_.skipped();
  status.counters.frames_dropped = frames_.dropped();
  options_.on_status(status);
}

}  // namespace chorus::server

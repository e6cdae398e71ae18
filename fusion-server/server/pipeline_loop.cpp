#include "fusion-server/server/pipeline_loop.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "common/base/log.h"
#include "fusion-server/wire/registration_resource.h"

namespace chorus::server {
namespace {

constexpr std::size_t kMostFrames = 4096;   // 64 sensors at 30 Hz for two seconds
constexpr std::size_t kMostCommands = 256;  // people, not frames, send these
constexpr Duration kMostIdle = std::chrono::milliseconds(20);
constexpr Duration kGathering = std::chrono::milliseconds(2);
constexpr Duration kStatusInterval = std::chrono::milliseconds(200);
/// What broke may break again at once, at every turn.
constexpr Duration kAfterFailure = std::chrono::milliseconds(10);
constexpr Duration kStale = std::chrono::milliseconds(1500);

constexpr std::string_view kOutOfOrder =
    "a frame was captured before the one it follows, and is refused: the clock of the sensor's "
    "host "
    "was set back, or it numbers its frames wrongly";

/// Around one frame interval, the alignment delay, and what nobody should see [s].
const std::vector<double> kAgeBounds{0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.15, 0.2, 0.5};

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

std::string_view name_of(core::SolveKind kind) {
  return kind == core::SolveKind::Final ? "final" : "provisional";
}

/// Whatever a library throws over strange clouds, the worker lives and the session learns of it.
Registration solution_of(const core::SolveJob& job, Timestamp now) {
  try {
    return registration::solve(job.walk, now, job.config);
  } catch (const std::exception& thrown) {
    Registration failed;
    failed.verdict = Verdict::Refused;
    failed.reasons = {std::string("the walk could not be solved: ") + thrown.what()};
    return failed;
  }
}

void save(const RegistrationStore& store, const Registration& registration) {
  if (auto ok = store.save(registration); !ok) {
    log::error("registration not stored", {{"reason", to_string(ok.error())}});
  }
}

}  // namespace

PipelineLoop::PipelineLoop(LoopOptions options)
    : options_(std::move(options)),
      core_(options_.core, options_.registration),
      frames_(kMostFrames),
      commands_(kMostCommands),
      solutions_(1),
      age_(kAgeBounds) {}

PipelineLoop::~PipelineLoop() {
  thread_.request_stop();
  frames_.close();
}

void PipelineLoop::start() {
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
  gather(std::min(core_.idle(options_.clock->now()), kMostIdle));
  for (Command& command : commands_.take(Duration{0})) obey(std::move(command));
  take_solutions();
  const auto begun = std::chrono::steady_clock::now();
  const Timestamp now = options_.clock->now();
  if (auto snapshot = core_.tick(now)) {
    publish(std::move(*snapshot));
    counters_.step_seconds += seconds(std::chrono::steady_clock::now() - begun);
  }
  if (const auto amended = core_.amended(now)) options_.on_amended(*amended);
  if (auto job = core_.due_job(now)) solve(std::move(*job));
  if (now - status_at_ >= kStatusInterval || now < status_at_) publish_status(now);
}

/// Takes the frames that are there, or the first that comes.  Of many sensors one comes every other
/// millisecond: those are left to gather, so that not each of them wakes this thread.
void PipelineLoop::gather(Duration idle) {
  const auto since = std::chrono::steady_clock::now() - gathered_at_;
  if (since < kGathering) {
    const Duration pause = std::min<Duration>(kGathering - since, idle);
    std::this_thread::sleep_for(pause);
    idle -= pause;
  }
  const std::vector<SensorFrame> frames = frames_.take(idle);
  if (!frames.empty()) gathered_at_ = std::chrono::steady_clock::now();
  for (const SensorFrame& frame : frames) core_.take(frame);
}

void PipelineLoop::obey(Command command) {
  if (auto* start = std::get_if<StartSession>(&command)) {
    // A refusal here lost a race that the route has checked before; the session that runs goes on.
    if (core_.start_session(start->target)) {
      log::info("registration session started", {{"seconds", seconds(start->target)}});
    }
  } else if (std::holds_alternative<Forget>(command)) {
    core_.forget();
    log::info("registration forgotten");
    worker_.post([store = options_.store] {
      if (auto ok = store.forget(); !ok) {
        log::error("stored registration not forgotten", {{"reason", to_string(ok.error())}});
      }
    });
  } else {
    core_.reconfigure(std::move(std::get<core::CoreConfig>(command)));
  }
  publish_status(options_.clock->now());
}

void PipelineLoop::publish(Snapshot snapshot) {
  const auto shared = std::make_shared<const Snapshot>(std::move(snapshot));
  for (Sink* sink : options_.sinks) sink->publish(shared);
  ++counters_.ticks;
  age_.observe(seconds(options_.clock->now() - shared->instant));
}

void PipelineLoop::solve(core::SolveJob job) {
  const bool was_collecting = core_.session().collecting;
  if (job.kind == core::SolveKind::Provisional && was_collecting) {
    log::debug("registration solving", {{"sensors", job.walk.size()}});
  }
  worker_.post([this, job = std::move(job)] {
    solutions_.give({job.session, job.kind, solution_of(job, options_.clock->now())});
  });
}

void PipelineLoop::take_solutions() {
  for (core::Solution& solution : solutions_.take(Duration{0})) {
    const core::SolveKind kind = solution.kind;
    const bool adopted = core_.solved(std::move(solution));
    const Registration& now = core_.registration();
    if (adopted) {
      log::info("registration adopted", {{"version", now.version},
                                         {"solve", name_of(kind)},
                                         {"verdict", wire::name_of(now.verdict)},
                                         {"sensors", now.sensors.size()},
                                         {"reasons", joined(now.reasons)}});
    } else if (kind == core::SolveKind::Final) {
      log::warn("registration not adopted", {{"reasons", joined(core_.session().reasons)}});
    }
    if (kind == core::SolveKind::Final && !now.sensors.empty()) {
      worker_.post([store = options_.store, now] { save(store, now); });
    }
    publish_status(options_.clock->now());
  }
}

SensorStatus PipelineLoop::status_of(const poll::PollReport& report, Timestamp now) const {
  SensorStatus status;
  status.id = report.sensor.id;
  status.url = report.sensor.url;
  if (report.newest) status.age = now - *report.newest;
  const bool silent = report.state == poll::SensorState::Live && status.age && *status.age > kStale;
  status.state = poll::name_of(silent ? poll::SensorState::Lost : report.state);
  status.last_error = report.last_error;
  if (status.last_error.empty() && core_.refuses(report.sensor.id, now)) {
    status.last_error = std::string(kOutOfOrder);
  } else if (status.last_error.empty() && silent) {
    status.last_error =
        "its newest frame was captured " + log::number_text(seconds(*status.age)) +
        " s ago by our clock; it delivers nothing, or the clock of its host is wrong";
  }
  status.streaming = report.streaming;
  status.rate_hz = report.rate_hz;
  status.frames = report.frames;
  status.missed = report.missed;
  status.failures = report.failures;
  status.refused = core_.refused(report.sensor.id) + report.refused;
  const core::Share share = core_.share(report.sensor.id);
  status.share = share.in_time;
  status.share_afterwards = share.afterwards;
  status.awaited = share.awaited;
  if (report.clock) {
    status.clock_offset = report.clock->ours_minus_theirs;
    status.clock_uncertainty = report.clock->uncertainty;
    status.clock_corrected = poll::correction(report.clock) != Duration{0};
  }
  const auto& reports = core_.reports();
  const auto own = std::find_if(reports.begin(), reports.end(), [&](const SensorReport& r) {
    return r.sensor == report.sensor.id;
  });
  if (own != reports.end()) {
    status.bodies = own->bodies;
    status.weight = own->weight;
  }
  return status;
}

void PipelineLoop::publish_status(Timestamp now) {
  status_at_ = now;
  Status status;
  for (const poll::PollReport& report : options_.poll_reports()) {
    status.sensors.push_back(status_of(report, now));
  }
  status.registration = core_.registration();
  status.session = core_.session();
  status.counters = counters_;
  status.counters.age = age_.snapshot();
  status.counters.jobs_failed = worker_.failed();
  status.counters.ticks_skipped = core_.skipped();
  status.counters.frames_dropped = frames_.dropped();
  options_.on_status(status);
}

}  // namespace chorus::server

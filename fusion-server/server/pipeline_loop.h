// The pipeline's thread: takes frames as they come, ticks at the output rate, hands snapshots out.
#pragma once

#include <functional>
#include <memory>
#include <thread>
#include <variant>
#include <vector>

#include "common/base/handover.h"
#include "common/base/rate_report.h"
#include "common/time/clock.h"
#include "fusion-server/core/fusion_core.h"
#include "fusion-server/poll/poller.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/server/worker.h"
#include "fusion-server/sink.h"
#include "fusion-server/status.h"

namespace chorus::server {

// What other threads may ask of the pipeline.
struct StartSession {
  Duration target{0};
};
struct Forget {};
using Command = std::variant<StartSession, Forget, core::CoreConfig>;

struct LoopOptions {
  core::CoreConfig core;
  Registration registration;
  RegistrationStore store{""};
  std::shared_ptr<const Clock> clock;
  std::vector<Sink*> sinks;  ///< Outlive the loop.
  /// Called a few times a second and whenever the registration has changed, on the pipeline's
  /// thread.
  std::function<void(const Status&)> on_status;
  std::function<std::vector<poll::PollReport>()> poll_reports;
  /// An earlier snapshot with the frames that came too late for it, on the pipeline's thread.
  std::function<void(const Snapshot&)> on_amended;
};

class PipelineLoop {
 public:
  explicit PipelineLoop(LoopOptions options);
  ~PipelineLoop();  ///< Stops and joins.

  void start();

  /// Never blocks; the oldest frames are dropped when the pipeline does not keep up.
  void give(SensorFrame frame) { frames_.give(std::move(frame)); }
  /// Taken within one output interval.
  void ask(Command command) { commands_.give(std::move(command)); }

 private:
  void run(const std::stop_token& stop);
  void turn();
  void gather(Duration idle);
  void obey(Command command);
  void publish(Snapshot snapshot);
  void solve(core::SolveJob job);
  void take_solutions();
  void publish_status(Timestamp now);
  [[nodiscard]] SensorStatus status_of(const poll::PollReport& report, Timestamp now) const;

  LoopOptions options_;
  core::FusionCore core_;
  Handover<SensorFrame> frames_;
  Handover<Command> commands_;
  Handover<core::Solution> solutions_;
  Counters counters_;
  Histogram age_;  ///< Instant to publication [s].
  Timestamp status_at_{};
  std::chrono::steady_clock::time_point gathered_at_{};
  RateReport trouble_{"pipeline step failed", log::Level::Error};
  Worker worker_;
  std::jthread thread_;
};

}  // namespace chorus::server

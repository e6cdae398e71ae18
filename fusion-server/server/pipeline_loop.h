// The pipeline's thread: takes frames as they come, runs the pipeline at the output rate, publishes
// snapshots.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "common/base/handover.h"
#include "common/base/rate_report.h"
#include "common/client/followers.h"
#include "common/inertial/inertial_frame.h"
#include "common/time/clock.h"
#include "fusion-server/core/fusion_core.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/server/state_keeper.h"
#include "fusion-server/server/worker.h"
#include "fusion-server/sink.h"
#include "fusion-server/status/sensor_status.h"
#include "fusion-server/status/server_status.h"
#include "fusion-server/status/session_status.h"

namespace chorus::server {

// Requests from other threads.  Tickets increase; Status contains the last one carried out.
struct StartSession {
  Duration target{0};
  Adoption adoption = Adoption::AtOnce;
  std::uint64_t session = 0;  ///< The id that was returned to the client.
  std::uint64_t ticket = 0;
};
struct CancelSession {
  std::uint64_t session = 0;
  std::uint64_t ticket = 0;
};
struct Forget {
  std::uint64_t ticket = 0;
};
struct MoveOrigin {
  core::Origin origin;
  std::uint64_t ticket = 0;
};
/// Takes the place of one sensor back, so that it is registered again.
struct RegisterAnew {
  SensorId sensor;
  std::uint64_t ticket = 0;
};
struct Undo {
  std::uint64_t ticket = 0;
};
/// Puts the proposed registration into use, or forgets it.
struct Decide {
  bool accept = false;
  std::uint64_t ticket = 0;
};
struct ForgetPerson {
  PersonId person;
};
using Command = std::variant<StartSession, CancelSession, Forget, MoveOrigin, RegisterAnew, Undo,
                             Decide, ForgetPerson, core::CoreConfig>;

struct LoopOptions {
  core::CoreConfig core;
  Registration registration;
  RegistrationStore store{""};
  std::string store_trouble;  ///< Why the store's folder cannot be used; empty if it can.
  std::string store_damage;   ///< As StorageStatus::damage.
  std::shared_ptr<const Clock> clock;
  std::vector<Sink*> sinks;  ///< Must outlive the loop.
  /// Called on the pipeline's thread, a few times a second and after each command and each solve.
  std::function<void(const Status&)> on_status;
  std::function<std::vector<client::FollowReport>()> poll_reports;
  /// Called on the pipeline's thread with an earlier snapshot that was fused again with late
  /// frames.
  std::function<void(const Snapshot&)> on_amended;
  /// Called on the same thread with a snapshot before it is published.
  std::function<void(Snapshot&)> complete = [](Snapshot&) {};
};

class PipelineLoop {
 public:
  explicit PipelineLoop(LoopOptions options);
  ~PipelineLoop();  ///< Stops and joins the thread.

  void start();

  /// Never blocks; if the pipeline falls behind, the oldest frames are dropped.
  void give(SensorFrame frame) { frames_.give(std::move(frame)); }
  void give(inertial::InertialFrame frame) { orientations_.give(std::move(frame)); }
  /// The command usually takes effect within 20 ms.
  void ask(Command command) { commands_.give(std::move(command)); }

 private:
  void run(const std::stop_token& stop);
  void turn();
  void gather(Duration idle);
  void obey(Command command);
  void start_session(const StartSession& wish);
  void cancel_session(const CancelSession& wish);
  void forget(const Forget& wish);
  void move_origin(const MoveOrigin& wish);
  void register_anew(const RegisterAnew& wish);
  void undo(const Undo& wish);
  void decide(const Decide& wish);
  void publish(Snapshot snapshot);
  void solve(core::SolveJob job);
  void take_solutions();
  void publish_status(Timestamp now);
  void note_displaced();
  void complain(const SensorStatus& sensor);
  void tell_of_worn(const std::vector<WornReport>& worn);
  [[nodiscard]] SensorStatus status_of(const client::FollowReport& report, Timestamp now) const;
  void add_following(const client::FollowReport& report, Timestamp now, SensorStatus& status) const;

  LoopOptions options_;
  core::FusionCore core_;
  Handover<SensorFrame> frames_;
  Handover<inertial::InertialFrame> orientations_;
  Handover<Command> commands_;
  Handover<core::Solution> solutions_;
  std::map<SensorId, std::string> told_;       ///< The last complaint that was logged, by sensor.
  std::map<SensorId, std::string> told_worn_;  ///< The same of inertial sources.
  Counters counters_;
  Histogram age_;  ///< Time from instant to publication [s].
  Timestamp status_at_{};
  Duration gathering_;  ///< Least time from taking frames to taking the next ones.
  std::chrono::steady_clock::time_point gathered_at_{};
  std::uint64_t displaced_ = 0;  ///< FusionCore::displaced() when it was last stored.
  std::uint64_t obeyed_ = 0;     ///< Ticket of the last command carried out.
  StateKeeper keeper_;
  RateReport trouble_{"pipeline step failed", log::Level::Error};
  Worker worker_;
  std::jthread thread_;
};

}  // namespace chorus::server

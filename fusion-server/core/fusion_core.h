// All state of the pipeline thread: histories, tracks, registration and its session.
//
// It uses no thread, socket or clock: frames, commands and solutions go in, snapshots and jobs come
// out.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "fusion-server/core/contests.h"
#include "fusion-server/core/core_config.h"
#include "fusion-server/core/cross_fade.h"
#include "fusion-server/core/decided_world.h"
#include "fusion-server/core/guard.h"
#include "fusion-server/core/registrar.h"
#include "fusion-server/core/sensor_memory.h"
#include "fusion-server/core/strays.h"
#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/status/registration_progress.h"
#include "fusion-server/status/sensor_status.h"
#include "fusion-server/status/session_status.h"
#include "fusion-server/worn/wear.h"

namespace chorus::core {

class FusionCore {
 public:
  FusionCore(CoreConfig config, Registration registration);

  void reconfigure(CoreConfig config);
  void take(SensorFrame frame);
  /// What an inertial source said, its times by our clock.
  void take(inertial::InertialFrame frame) { wear_.take(std::move(frame)); }

  /// The next snapshot if it is due.
  [[nodiscard]] std::optional<Snapshot> tick(Timestamp now);
  /// An earlier snapshot fused again with frames that came too late for it; people keep their ids.
  /// Call it after each tick; usually there is none.
  [[nodiscard]] std::optional<Snapshot> amended(Timestamp now);
  /// Snapshots of seconds ago, fused again with what has been seen since (pipeline/smoother.h),
  /// each once; none unless SmoothingConfig::live.  Call it after each tick.
  [[nodiscard]] std::vector<Snapshot> smoothed() { return std::exchange(told_.smoothed, {}); }
  /// For how long nothing will be due unless a frame arrives.
  [[nodiscard]] Duration idle(Timestamp now);

  /// See Registrar.
  [[nodiscard]] Result<std::uint64_t> start_session(Duration target, Timestamp now,
                                                    Adoption adoption = Adoption::AtOnce) {
    return registrar_.start(target, now, adoption);
  }
  [[nodiscard]] Result<void> cancel_session(std::uint64_t session, Timestamp now) {
    return registrar_.cancel(session, now);
  }
  /// Cancels the session and forgets the registration.
  void forget();
  /// Forgets a person: the id, the build by which they would be recognised, the slot.  If they are
  /// in view, they are somebody new.
  void forget(PersonId person);
  /// As Registrar::move_origin.
  [[nodiscard]] Result<void> move_origin(const Origin& origin);
  /// As Registrar::release.
  [[nodiscard]] Result<void> register_anew(const SensorId& sensor);
  /// As Registrar::undo.
  [[nodiscard]] Result<void> undo();
  /// As Registrar::accept and Registrar::decline.
  [[nodiscard]] Result<void> accept();
  [[nodiscard]] Result<void> decline() { return registrar_.decline(); }
  [[nodiscard]] const std::optional<Registration>& earlier() const { return registrar_.earlier(); }
  void set_earlier(Registration registration) { registrar_.set_earlier(std::move(registration)); }
  [[nodiscard]] std::optional<SolveJob> due_job(Timestamp now) { return registrar_.due_job(now); }
  Outcome solved(Solution solution, Timestamp now);

  [[nodiscard]] const Registration& registration() const { return registrar_.registration(); }
  /// The whole progress except storage and commands, which are handled elsewhere.
  [[nodiscard]] RegistrationProgress progress(Timestamp now) const;

  [[nodiscard]] const std::vector<SensorReport>& reports() const noexcept { return told_.reports; }
  /// Whether the weights in reports() mean anything to the method in use.
  [[nodiscard]] bool uses_weights() const {
    return pipeline::uses_weights(config_.pipeline.fusion.method);
  }
  /// Number of bodies in the sensor's newest frame, whether the sensor has a place or not.
  [[nodiscard]] std::size_t bodies(const SensorId& sensor, Timestamp now) const {
    return registrar_.last_seen().bodies(sensor, now);
  }
  /// What became of the sensor's frames, and how it contributed; of an unknown one: nothing.
  [[nodiscard]] const SensorMemory& memory_of(const SensorId& sensor) const;
  /// Which sensors do not stand where they were registered, as far as known.
  [[nodiscard]] const Guard& guard() const noexcept { return guard_; }
  /// The alarm as a sentence for people; empty if there is none.
  [[nodiscard]] std::string alarm_text(const SensorId& sensor, Timestamp now) const;
  /// Who contradicts what this sensor sees, as a sentence for people; empty if nobody does.
  [[nodiscard]] std::string contested(const SensorId& sensor) const {
    return contests_.sentence_of(sensor);
  }
  /// How many bodies the sensor has seen since the start that nobody believed.
  [[nodiscard]] std::uint64_t contests(const SensorId& sensor) const {
    return contests_.count_of(sensor);
  }
  /// What is known of the inertial sources and who wears them; empty while they are not used.
  [[nodiscard]] std::vector<WornReport> worn(Timestamp now) const { return wear_.reports(now); }
  /// How often a sensor lost its place because it was moved.
  [[nodiscard]] std::uint64_t displaced() const noexcept { return guard_.times_displaced(); }
  [[nodiscard]] std::uint64_t skipped() const noexcept { return schedule_.skipped(); }
  /// All persons so far have lower ids.
  [[nodiscard]] std::uint64_t next_person() const noexcept { return memory_.tracks.next_id; }

 private:
  /// What is told beside the snapshots; a change of places takes nothing of it back.
  struct Told {
    std::vector<SensorReport> reports;
    std::vector<Snapshot> smoothed;  ///< Not fetched yet.
  };

  void change_places(Registration before);
  void leave_world();
  [[nodiscard]] bool is_stray(const SensorId& sensor) const;
  void note_places(const Registration& before);
  [[nodiscard]] pipeline::Step step_at(const Tick& tick, Timestamp now);
  void smooth(const pipeline::Inputs& in, const pipeline::Perceived& seen);
  void displace_moved(Timestamp instant);
  [[nodiscard]] SensorFrame in_step(SensorFrame frame);
  void sift(SensorFrame& frame);
  [[nodiscard]] bool improves(const Answered& answered, Timestamp now) const;

  CoreConfig config_;
  TickSchedule schedule_;
  pipeline::Histories histories_;
  pipeline::Memory memory_;
  SensorMemories sensors_;
  Registrar registrar_;
  DecidedWorld world_;
  CrossFade fade_;
  Told told_;
  Guard guard_;
  Strays strays_;
  Contests contests_;
  worn::Wear wear_;
};

}  // namespace chorus::core

// Collects a person's walk until the sensors' places can be solved (Otto 5.2.1).
//
// It uses no I/O and no clock: frames go in, and at times a solve is due. The walk is kept in
// chunks that are shared with the solver, so that a solve need not copy it here.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/strong_id.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"
#include "fusion-server/core/coverage.h"
#include "fusion-server/registration/registration.h"
#include "fusion-server/status/session_status.h"

namespace chorus::core {

struct SessionConfig {
  bool automatic = true;  ///< Sessions start by themselves when a sensor that sees a body has no
                          ///< place yet.
  Adoption adoption = Adoption::AtOnce;        ///< For sessions whose client does not choose one.
  Duration target = std::chrono::seconds(30);  ///< Length of walk until the final solve.
  Duration first_solve = std::chrono::seconds(6);  ///< Length of walk until the first solve.
  Duration solve_every = std::chrono::seconds(2);
  /// A longer pause with nobody in view does not count as walking.
  Duration max_pause = std::chrono::milliseconds(500);
  /// The session ends before `target` once a provisional solve places all sensors that take part
  /// this well: 95 % radius on the floor, relative to the master [m].  Zero: it never ends early.
  double target_radius = 0.0;
  std::size_t max_frames = 20000;  ///< Per sensor; more are dropped, so that memory stays bounded.

  bool operator==(const SessionConfig&) const = default;
};

enum class SolveKind { Provisional, Final };

/// What one sensor saw, in capture order; immutable.
struct SharedTrack {
  SensorId sensor;
  std::vector<std::shared_ptr<const std::vector<SensorFrame>>> chunks;
};
using SharedWalk = std::vector<SharedTrack>;

/// The whole walk in the form that solvers take; copies every frame.
[[nodiscard]] std::vector<registration::WalkTrack> assembled(const SharedWalk& walk);

class RegistrationSession {
 public:
  explicit RegistrationSession(SessionConfig config) : config_(config) {}

  /// Starts collecting; drops the walk collected before.
  void start(Duration target);
  void cancel();
  /// Changes the length of walk that is wanted; keeps what was collected.
  void retarget(Duration target) { target_ = target; }
  /// Makes the final solve due at once.
  void finish() { target_ = std::min(target_, elapsed_); }

  /// Adds a frame; one without bodies only shows that nobody is in view.
  void add(const SensorFrame& frame);

  /// Which solve should run now on what walk() gives; none if none is due.  Each solve is returned
  /// once.  After Final the session no longer collects.
  [[nodiscard]] std::optional<SolveKind> due();
  [[nodiscard]] bool final_due() const noexcept { return collecting_ && elapsed_ >= target_; }
  /// Takes the duration of the last solve; the next provisional one waits at least three times as
  /// long.
  void solved_in(Duration cost) { cost_ = cost; }

  [[nodiscard]] bool collecting() const noexcept { return collecting_; }
  [[nodiscard]] Duration elapsed() const noexcept { return elapsed_; }
  [[nodiscard]] Duration target() const noexcept { return target_; }
  /// What the walk has covered; kept after its end until the next walk starts.
  [[nodiscard]] const Coverage& coverage() const noexcept { return coverage_; }
  /// Shares the walk collected so far; once collecting has ended, hands it over.
  [[nodiscard]] SharedWalk walk();

 private:
  using Chunk = std::vector<SensorFrame>;
  struct Track {
    std::vector<std::shared_ptr<const Chunk>> sealed;
    std::shared_ptr<Chunk> open;
    std::size_t frames = 0;
    Timestamp last;
  };
  static void seal(Track& track);

  SessionConfig config_;
  bool collecting_ = false;
  Duration target_{0};
  Duration elapsed_{0};
  Duration solved_at_{0};  ///< Elapsed time at the last solve.
  Duration cost_{0};       ///< Duration of the last solve.
  std::optional<Timestamp> last_seen_;
  std::map<SensorId, Track> tracks_;
  Coverage coverage_;
};

}  // namespace chorus::core

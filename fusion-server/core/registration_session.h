// Watching somebody walk until the sensors' places can be solved (Otto 5.2.1).
//
// Without IO and without a clock: frames go in, at some point a solve is due.  The walk is kept in
// chunks that are shared with whoever solves it, so that nothing is copied here.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "fusion-server/flow.h"
#include "fusion-server/registration/registration.h"

namespace chorus::core {

struct SessionConfig {
  bool automatic = true;  ///< Start by itself when a sensor that sees somebody has no place yet.
  Duration target = std::chrono::seconds(30);      ///< Seconds of walk until the final solve.
  Duration first_solve = std::chrono::seconds(6);  ///< First provisional solve.
  Duration solve_every = std::chrono::seconds(2);
  /// A longer time with nobody in sight does not count as walking.
  Duration max_pause = std::chrono::milliseconds(500);
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

/// In one piece, as solvers want it: copies every frame.
[[nodiscard]] std::vector<registration::WalkTrack> assembled(const SharedWalk& walk);

class RegistrationSession {
 public:
  explicit RegistrationSession(SessionConfig config) : config_(config) {}

  /// Starts to collect; what was collected before is forgotten.
  void start(Duration target);
  void cancel();
  /// Sets how much walk is wanted from now on; what was collected stays.
  void retarget(Duration target) { target_ = target; }

  /// Takes note of a frame; one without bodies only shows that nobody is there.
  void add(const SensorFrame& frame);

  /// At most one answer per step of the walk: a solve of walk() that should run now.  After Final
  /// the session no longer collects.
  [[nodiscard]] std::optional<SolveKind> due();
  [[nodiscard]] bool final_due() const noexcept { return collecting_ && elapsed_ >= target_; }
  /// How long the last solve took: the next provisional one waits three times as long.
  void solved_in(Duration cost) { cost_ = cost; }

  [[nodiscard]] bool collecting() const noexcept { return collecting_; }
  [[nodiscard]] Duration elapsed() const noexcept { return elapsed_; }
  [[nodiscard]] Duration target() const noexcept { return target_; }
  /// Shares what has been collected; once collecting has ended, hands it over.
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
  Duration solved_at_{0};  ///< Elapsed time of the last solve.
  Duration cost_{0};       ///< Of the last solve.
  std::optional<Timestamp> last_seen_;
  std::map<SensorId, Track> tracks_;
};

}  // namespace chorus::core

// Watching somebody walk until the sensors' places can be solved (Otto 5.2.1).
//
// Without IO and without a clock: frames go in, at some point a solve is due, its result is weighed
// against what we have.  The server runs the solving on a worker thread.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fusion-server/flow.h"
#include "fusion-server/registration/registration.h"

namespace chorus::core {

struct SessionConfig {
  bool automatic = true;  ///< Start by itself when a sensor that sees somebody has no place yet.
  Duration target = std::chrono::seconds(30);      ///< Seconds of walk until the final solve.
  Duration first_solve = std::chrono::seconds(6);  ///< First provisional solve.
  Duration solve_every = std::chrono::seconds(2);
  Duration max_pause =
      std::chrono::milliseconds(500);  ///< Nobody in sight for longer is not walking.
  std::size_t max_frames = 20000;  ///< Per sensor; more are dropped, so that memory stays bounded.

  bool operator==(const SessionConfig&) const = default;
};

enum class SolveKind { Provisional, Final };

class RegistrationSession {
 public:
  explicit RegistrationSession(SessionConfig config) : config_(config) {}

  /// Starts to collect; what was collected before is forgotten.
  void start(Duration target);
  void cancel();
  /// Gives the collected frames back to memory; elapsed and target stay readable.
  void release() { tracks_.clear(); }

  /// Takes note of a frame; one without bodies only shows that nobody is there.
  void add(const SensorFrame& frame);

  /// At most one answer per step of walk: a solve that should run now on walk().  After Final the
  /// session is no longer collecting.
  [[nodiscard]] std::optional<SolveKind> due();

  [[nodiscard]] bool collecting() const noexcept { return collecting_; }
  [[nodiscard]] Duration elapsed() const noexcept { return elapsed_; }
  [[nodiscard]] Duration target() const noexcept { return target_; }
  [[nodiscard]] std::vector<registration::WalkTrack> walk() const;

 private:
  SessionConfig config_;
  bool collecting_ = false;
  Duration target_{0};
  Duration elapsed_{0};
  Duration solved_at_{0};  ///< Elapsed time of the last solve.
  std::optional<Timestamp> last_seen_;
  std::map<SensorId, std::vector<SensorFrame>> tracks_;
};

/// Whether the candidate should replace what we have: never a refused one, never a worse verdict or
/// a smaller circle of sensors.  `final` candidates of equal standing replace, so that a new walk
/// counts.
[[nodiscard]] bool should_adopt(const Registration& current, const Registration& candidate,
                                SolveKind kind);

/// The sensors among `seeing` (those that saw a body lately) that have no place.
[[nodiscard]] std::set<SensorId> unplaced(const Registration& current,
                                          const std::set<SensorId>& seeing);

}  // namespace chorus::core

// A room in everyday use in which one sensor is pushed: the fusion server's core, with its own
// registration, processes the frames of simulated sensors one by one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion-server/watch/watch_config.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

/// A sensor is moved within one frame, at `at` after the beginning.
struct Push {
  std::size_t sensor = 0;
  Duration at = std::chrono::seconds(60);
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< World [m].
  double yaw = 0.0;                                 ///< About the vertical through it [rad].
};

struct RoomSetting {
  std::string profile = "A";
  std::uint64_t seed = 1;
  std::size_t sensors = 6;
  std::size_t persons = 1;
  Duration length = std::chrono::seconds(60);
  std::optional<Push> push = {};
  watch::WatchConfig watch = {.enabled = true};
};

/// What happened, by true time; durations count from the beginning.
struct RoomLog {
  struct Alarm {
    Duration at{0};
    std::size_t sensor = 0;
    bool pair = false;  ///< True if the alarm names two sensors, of which one was moved.
  };
  std::vector<Alarm> alarms;                  ///< One entry for each alarm that is raised.
  std::optional<Duration> placed_again = {};  ///< When the pushed sensor was registered again.
  double place_again_error = 0.0;             ///< Error of its pose at the end [m].
  /// Largest distance between the step of a person's trunk from one instant to the next and the
  /// true step [m]: before the push, and from then on.
  double step_before = 0.0;
  double step_after = 0.0;
  double body_error_before = 0.0;  ///< Mean error of the trunk in the 10 s before the push [m].
  double body_error_after = 0.0;   ///< The same in the last 10 s.
  double walked = 0.0;             ///< Simulated time [s].
};

[[nodiscard]] RoomLog live_in(const RoomSetting& setting);

}  // namespace chorus::bench

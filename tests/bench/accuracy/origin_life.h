// The life of a cell after people have marked its world: it is registered again and again, by other
// walks, with another master, after a restart, without a sensor, with a new one, with one that was
// pushed.  The fusion server's core decides each time; frames come from simulated sensors.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chorus::bench {

struct LifeSetting {
  std::string profile = "A";
  std::uint64_t seed = 1;
  std::size_t again = 10;  ///< Number of re-registrations before anything else happens.
  double push = 0.15;      ///< How far one sensor is pushed at the end [m].
};

/// Where a point on the floor, marked in the middle of the workspace, is found after a step,
/// compared with where it was when the origin was set on it.  Found: by the mean over all sensors
/// of where they put it.
struct Drift {
  double horizontal = 0.0;  ///< [m]
  double vertical = 0.0;    ///< [m]
  double yaw = 0.0;         ///< Of the directions between marks up to 1.4 m away [rad].
  double corner = 0.0;      ///< Horizontal drift of the worst of four marks 1.4 m away [m].
  double waist = 0.0;       ///< Horizontal drift of a point 1 m above the mark [m].
};

struct Life {
  std::vector<Drift> again;         ///< After each re-registration by the same sensors.
  std::vector<Drift> other_master;  ///< Places given up and found anew with another master.
  std::vector<Drift> restart;       ///< Written to the file and read from it, then registered.
  std::vector<Drift> removed;       ///< One sensor taken out, then registered.
  std::vector<Drift> added;         ///< Another one placed beside them, then all registered.
  std::vector<Drift> pushed;        ///< One sensor pushed, then all registered.
  double held_shift = 0.0;          ///< Largest movement of a held sensor while one is added [m].
  std::size_t refused = 0;          ///< Walks that were not adopted.
};

[[nodiscard]] Life live_on(const LifeSetting& setting);

}  // namespace chorus::bench

// The whole tracker as its users run it: six chorus-sensor and one chorus-fusion process on
// loopback, and what a client sees of them.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/synthetic/host_clock.h"
#include "common/time/timestamp.h"
#include "tests/bench/live/child_process.h"

namespace chorus::bench {

inline constexpr int kSystemSensors = 6;

/// What is wrong with a sensor host's clock, from the start of its service; the server's is right.
struct HostError {
  int offset_ms = 0;
  int drift_ppm = 0;
  int step_ms = 0;  ///< Once, kStepAfter after the start.
};
inline constexpr std::chrono::seconds kStepAfter{40};  // in the middle of what is watched

struct SystemCase {
  std::string name;               ///< "six-sensors-A"
  std::string profile = "gauss";  ///< Of the simulated sensors.
  std::array<HostError, kSystemSensors> hosts = {};
  double run_seconds = 60.0;  ///< Watched, after registration.
};

struct Rig {
  std::vector<ChildProcess> sensors;
  std::vector<ChildProcess> fusion;  ///< One.
  std::vector<std::uint16_t> sensor_ports;
  std::vector<synthetic::HostClock> clocks;  ///< Of the sensors' hosts, as they were set.
  std::uint16_t port = 0;
};

[[nodiscard]] Result<Rig> start_rig(const SystemCase& asked);

/// Until the walk is registered and its session over, so that the measured time is steady work.
/// The time to the first fused body [s].
[[nodiscard]] Result<double> wait_until_registered(const Rig& rig);

/// One frame as a client got it.
struct Seen {
  std::int64_t sequence = 0;
  Timestamp captured;  ///< As stated, by the sensor host's clock.
  Timestamp received;  ///< By ours.
  std::string turtle;
};

struct Cpu {
  double sensors = 0.0;
  double fusion = 0.0;
};

struct Observed {
  std::vector<Seen> fused;
  std::vector<std::vector<Seen>> sensors;
  Cpu cpu;  ///< Used during the run [s].
  double elapsed = 0.0;
};

/// Long-polls the fused frame and, beside the fusion server, every sensor, so that both is known:
/// when light hit the sensors and when the fused frame was on the wire.
[[nodiscard]] Observed observe(const Rig& rig, double run_seconds);

/// Body of a GET; empty on failure.
[[nodiscard]] std::string body_of(const Rig& rig, const char* path, const char* accept);

}  // namespace chorus::bench

// The whole tracker as users run it: six chorus-sensor processes and one chorus-fusion process on
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

/// Errors of a sensor host's clock, from the start of its service; the server's clock is right.
struct HostError {
  int offset_ms = 0;
  int drift_ppm = 0;
  int step_ms = 0;  ///< Step made kStepAfter after the start.
};
inline constexpr std::chrono::seconds kStepAfter{40};  // in the middle of the watched time

struct SystemCase {
  std::string name;               ///< "six-sensors-A"
  std::string profile = "gauss";  ///< Profile of the simulated sensors.
  std::array<HostError, kSystemSensors> hosts = {};
  double run_seconds = 60.0;  ///< Watched time, after registration.
};

struct Rig {
  std::vector<ChildProcess> sensors;
  std::vector<ChildProcess> fusion;  ///< One process.
  std::vector<std::uint16_t> sensor_ports;
  std::vector<synthetic::HostClock> clocks;  ///< Clocks of the sensor hosts, as they were set.
  std::uint16_t port = 0;
};

[[nodiscard]] Result<Rig> start_rig(const SystemCase& asked);

/// Waits until the walk is registered and its session is over, so that the measured load is steady.
/// Returns the time to the first fused body [s].
[[nodiscard]] Result<double> wait_until_registered(const Rig& rig);

/// One frame as a client received it.
struct Seen {
  std::int64_t sequence = 0;
  Timestamp captured;  ///< As stamped: by the sensor host, or by the server if fused.
  Timestamp received;  ///< By our clock.
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

/// Long-polls the fused frame and every sensor's frame, so that both times are known: when light
/// hit the sensors, and when the fused frame was on the wire.
[[nodiscard]] Observed observe(const Rig& rig, double run_seconds);

/// Body of the answer to a GET; empty on failure.
[[nodiscard]] std::string body_of(const Rig& rig, const char* path, const char* accept);

}  // namespace chorus::bench

#include "services/sensor/host_clock.h"

namespace chorus::sensor_service {
namespace {

constexpr Duration kLargest = std::chrono::hours(24);
constexpr double kMillion = 1e6;
constexpr double kMaxPpm = 10'000;  // No oscillator is off by a whole percent.

}  // namespace

void read_clock_errors(ConfigReader config, ClockErrors& out) {
  double ppm = out.drift * kMillion;
  config.read_ms("offset_ms", out.offset, -kLargest, kLargest);
  config.read("drift_ppm", ppm, -kMaxPpm, kMaxPpm);
  config.read_ms("step_ms", out.step, -kLargest, kLargest);
  config.read_s("step_after_s", out.step_after, Duration::zero(), 365 * kLargest);
  out.drift = ppm / kMillion;
}

synthetic::HostClock host_clock(const ClockErrors& errors, Timestamp start) {
  synthetic::HostClock host;
  host.offset = seconds(errors.offset);
  host.drift = errors.drift;
  host.step = seconds(errors.step);
  host.origin = start;
  host.step_at = start + errors.step_after;
  return host;
}

}  // namespace chorus::sensor_service

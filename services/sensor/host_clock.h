// A wrong host clock, for testing everything that has to tolerate one.
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/synthetic/host_clock.h"
#include "common/time/clock.h"

namespace chorus::sensor_service {

/// Errors to simulate in the host's clock.  Drift and `step_after` count from the start of the
/// service.
struct ClockErrors {
  Duration offset{0};
  double drift = 0.0;  ///< [s/s]
  Duration step{0};    ///< The clock steps once by this, as NTP steps a clock.
  Duration step_after = std::chrono::seconds(60);

  bool operator==(const ClockErrors&) const = default;
};

/// Reads the section "clock"; the reader's finish() reports mistakes.
void read_clock_errors(ConfigReader config, ClockErrors& out);

[[nodiscard]] synthetic::HostClock host_clock(const ClockErrors& errors, Timestamp start);

/// What the host's clock shows while the true time is that of `world`.
class ErringClock final : public Clock {
 public:
  ErringClock(std::shared_ptr<const Clock> world, const synthetic::HostClock& host)
      : world_(std::move(world)), host_(host) {}
  [[nodiscard]] Timestamp now() const override { return host_.host_time(world_->now()); }

 private:
  std::shared_ptr<const Clock> world_;
  synthetic::HostClock host_;
};

}  // namespace chorus::sensor_service

// True time, and the time that this host's clock shows.
#pragma once

#include <memory>

#include "common/synthetic/host_clock.h"
#include "common/time/clock.h"

namespace chorus::sensor_service {

/// Devices follow true time; their frames are stamped by the host's clock.
struct HostTime {
  std::shared_ptr<const Clock> world;
  synthetic::HostClock host = {};
};

}  // namespace chorus::sensor_service

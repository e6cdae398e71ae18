#include "common/synthetic/host_clock.h"

namespace chorus::synthetic {

Timestamp HostClock::host_time(Timestamp true_time) const {
  const double since = seconds(true_time - origin);
  return true_time + from_seconds(offset + drift * since + (true_time >= step_at ? step : 0.0));
}

}  // namespace chorus::synthetic

// When a streamed pose happened, by this host's clock.
//
// A suit states the time since its measurement began.  A pose that is not delayed arrives
// `latency` after it happened, so the least difference between arrival and stated time tells the
// two clocks' offset; it is let go slowly, for clocks that run differently.
#pragma once

#include <algorithm>
#include <optional>

#include "common/time/timestamp.h"

namespace chorus::suit {

class SuitClock {
 public:
  explicit SuitClock(Duration latency) : latency_(latency) {}

  /// The instant of a pose that arrived now.  A stated time that runs two seconds away from the
  /// clock (the measurement began anew) begins anew.
  Timestamp captured(Duration stated, Timestamp arrived) {
    constexpr Duration kAnew = std::chrono::seconds(2);
    constexpr double kDrift = 1e-4;  // Faster than any two clocks drift.
    const Duration offset = arrived.time_since_epoch() - stated;
    if (!offset_ || offset - *offset_ > kAnew || *offset_ - offset > kAnew) {
      offset_ = offset;
    } else {
      const double since = std::max(0.0, seconds(arrived - last_));
      offset_ = std::min(*offset_ + from_seconds(kDrift * since), offset);
    }
    last_ = arrived;
    return Timestamp(*offset_ + stated - latency_);
  }

 private:
  Duration latency_;
  std::optional<Duration> offset_{};
  Timestamp last_{};
};

}  // namespace chorus::suit

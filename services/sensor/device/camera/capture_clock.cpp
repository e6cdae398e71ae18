#include "services/sensor/device/camera/capture_clock.h"

#include <algorithm>
#include <chrono>

namespace chorus::camera {
namespace {

constexpr Duration kOldest = std::chrono::seconds(2);
// Two quartz clocks drift apart at less than this rate.  Without this allowance, capture times
// would fall behind if the stream's clock is slow.
constexpr double kDrift = 200e-6;
constexpr Duration kBreak = std::chrono::seconds(2);

}  // namespace

Timestamp captured_by_driver(Timestamp arrived, std::optional<Duration> age, Duration latency) {
  const bool believable = age && *age >= Duration::zero() && *age <= kOldest;
  return arrived - (believable ? *age : latency);
}

void StreamClock::begin(Timestamp arrived, Duration position) {
  known_ = true;
  origin_ = arrived - position;
  arrived_ = arrived;
  position_ = position;
}

Timestamp StreamClock::captured(Timestamp arrived, std::optional<Duration> position) {
  if (!position || (known_ && *position == position_)) return arrived - latency_;
  const bool broken = !known_ || *position < position_ || arrived < arrived_ ||
                      std::chrono::abs((*position - position_) - (arrived - arrived_)) > kBreak;
  if (broken) begin(arrived, *position);
  const Duration passed = arrived - arrived_;
  origin_ += from_seconds(seconds(passed) * kDrift);
  origin_ = std::min(origin_, arrived - *position);
  arrived_ = arrived;
  position_ = *position;
  return origin_ + *position - latency_;
}

}  // namespace chorus::camera

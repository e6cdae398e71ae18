#include "services/sensor/device/camera/file_pace.h"

#include <chrono>

namespace chorus::camera {
namespace {

constexpr Duration kNear = std::chrono::seconds(1);

}  // namespace

Duration FilePace::begin(const FileTiming& timing, Timestamp now) {
  const bool again = begun_;
  const Timestamp end = epoch_ + timing_.length.value_or(position_ + timing_.step);
  timing_ = timing;
  begun_ = true;
  first_ = true;
  if (again && std::chrono::abs(now - end) < kNear) {
    epoch_ = end;
    return Duration{0};
  }
  epoch_ = now;
  if (!loop_ || !timing.length || *timing.length <= Duration::zero()) return Duration{0};
  epoch_ = now - now.time_since_epoch() % *timing.length;
  return now - epoch_;
}

Timestamp FilePace::due(std::optional<Duration> position) {
  // Some containers state no times for their last pictures.
  const bool advances = position && (first_ || *position > position_);
  if (advances)
    position_ = *position;
  else
    position_ = first_ ? Duration{0} : position_ + timing_.step;
  first_ = false;
  return epoch_ + position_;
}

}  // namespace chorus::camera

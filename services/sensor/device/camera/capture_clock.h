// When light hit the sensor, derived from when a picture arrived and from the camera's own clock.
// Pure: times in, times out.
#pragma once

#include <optional>

#include "common/base/duration.h"
#include "common/time/timestamp.h"

namespace chorus::camera {

/// A webcam's driver stamps each picture by the host's monotonic clock.  `age`: that clock's
/// present time minus the stamp.  Without a stamp, or with an implausible one, the latency is used
/// instead.
[[nodiscard]] Timestamp captured_by_driver(Timestamp arrived, std::optional<Duration> age,
                                           Duration latency);

/// For a stream, whose pictures carry the time since its beginning by its own clock: the picture
/// with the least delay determines the offset between the two clocks; all others are placed by the
/// stream's own time.  So capture times do not jitter as arrival times do.
class StreamClock {
 public:
  explicit StreamClock(Duration latency) : latency_(latency) {}

  /// `position`: the picture's time in the stream; without it, or if it is that of the picture
  /// before, the time of arrival minus the latency is used.
  [[nodiscard]] Timestamp captured(Timestamp arrived, std::optional<Duration> position);

 private:
  void begin(Timestamp arrived, Duration position);

  Duration latency_;
  bool known_ = false;
  Timestamp origin_{};  ///< Arrival of position zero, by the picture with the least delay.
  Timestamp arrived_{};
  Duration position_{0};
};

}  // namespace chorus::camera

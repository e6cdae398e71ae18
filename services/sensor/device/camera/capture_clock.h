// When light hit the sensor, from when a picture arrived and what the camera's own clock says.
// Pure: times in, times out.
#pragma once

#include <optional>

#include "common/base/duration.h"
#include "common/time/timestamp.h"

namespace chorus::camera {

/// A webcam's driver stamps each picture by the clock that has counted since the start of the host.
/// `age`: that clock's now minus the stamp.  The latency counts instead when there is no stamp, or
/// one that cannot be true.
[[nodiscard]] Timestamp captured_by_driver(Timestamp arrived, std::optional<Duration> age,
                                           Duration latency);

/// For a stream, whose pictures carry the time since its beginning by a clock of its own: the
/// picture that came through fastest tells how the two clocks stand to each other, and of the rest
/// only the stream's steps count.  So capture times do not jitter as arrival does.
class StreamClock {
 public:
  explicit StreamClock(Duration latency) : latency_(latency) {}

  /// `position`: of the picture in the stream; none, or one that does not advance: arrival counts.
  [[nodiscard]] Timestamp captured(Timestamp arrived, std::optional<Duration> position);

 private:
  void begin(Timestamp arrived, Duration position);

  Duration latency_;
  bool known_ = false;
  Timestamp origin_{};  ///< When position zero would have arrived, by the fastest picture.
  Timestamp arrived_{};
  Duration position_{0};
};

}  // namespace chorus::camera

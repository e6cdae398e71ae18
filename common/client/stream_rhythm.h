// Finds when a stream's next frame is overdue, and whether that has happened recently.  A packet
// that is lost twice holds up all later ones for a fifth of a second or more, while the connection
// for requests is free.
#pragma once

#include <optional>

#include "common/base/duration.h"

namespace chorus::client {

class StreamRhythm {
 public:
  /// Call this when a frame has come by stream.
  void saw(Duration now);

  /// The time from which the next frame is overdue, and worth a separate request. None if the
  /// stream was not late in the last minute: most streams seldom are, and need not be watched.
  [[nodiscard]] std::optional<Duration> overdue_from(Duration now) const;

  /// Call this for a new stream, which may be of a faster sensor.
  void restart();

 private:
  [[nodiscard]] Duration patience() const;

  std::optional<Duration> last_;
  Duration usual_{0};  ///< Usual interval between frames; zero: not known yet.
  std::optional<Duration> late_at_;
};

}  // namespace chorus::client

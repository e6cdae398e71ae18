// When a stream's next frame is overdue, and whether that happened recently: a packet lost twice
// holds up all later ones for a fifth of a second or more, while another connection is free.
#pragma once

#include <optional>

#include "common/base/duration.h"

namespace chorus::poll {

class StreamRhythm {
 public:
  /// To be called when a frame came by stream.
  void saw(Duration now);

  /// The time from which the next frame is overdue, and worth a separate request.  None if the
  /// stream was not late in the last minute: most never are, and need no such watch.
  [[nodiscard]] std::optional<Duration> overdue_from(Duration now) const;

  /// To be called for a new stream, perhaps of a faster sensor.
  void restart();

 private:
  [[nodiscard]] Duration patience() const;

  std::optional<Duration> last_;
  Duration usual_{0};  ///< Usual interval of frames; zero: not known yet.
  std::optional<Duration> late_at_;
};

}  // namespace chorus::poll

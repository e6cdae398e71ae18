// When a stream's next frame is overdue, and whether it has been of late: a packet lost twice holds
// up everything behind it for a fifth of a second and more, while another connection is free.
#pragma once

#include <optional>

#include "common/base/duration.h"

namespace chorus::poll {

class StreamRhythm {
 public:
  /// A frame came by stream.
  void saw(Duration now);

  /// From when on the next frame is overdue, and worth asking for beside the stream.  None while
  /// the stream has not been late for a minute: most never are, and nobody has to look.
  [[nodiscard]] std::optional<Duration> overdue_from(Duration now) const;

  /// A new stream, perhaps of a faster sensor.
  void restart();

 private:
  [[nodiscard]] Duration patience() const;

  std::optional<Duration> last_;
  Duration usual_{0};  ///< From frame to frame; zero: not known yet.
  std::optional<Duration> late_at_;
};

}  // namespace chorus::poll

// When each picture of a video file is due, at the file's own rate.
//
// A looping file begins its rounds at whole multiples of its length since 1970.  So several sensors
// that loop videos of the same length show them in step without communicating.
#pragma once

#include <optional>

#include "common/base/duration.h"
#include "common/time/timestamp.h"

namespace chorus::camera {

struct FileTiming {
  Duration step{0};                  ///< Time between two pictures.
  std::optional<Duration> length{};  ///< Length of the whole file; none: unknown.
};

class FilePace {
 public:
  explicit FilePace(bool loop) : loop_(loop) {}

  /// Call this each time the file has been opened.  Returns the position in the file that is due
  /// now.
  [[nodiscard]] Duration begin(const FileTiming& timing, Timestamp now);
  /// When the next picture is due.  `position`: the picture's time in the file, if the file states
  /// it.
  [[nodiscard]] Timestamp due(std::optional<Duration> position);
  /// Delays all further pictures by this much, because reading one took too long.
  void fall_behind(Duration by) { epoch_ += by; }

 private:
  bool loop_;
  FileTiming timing_;
  bool begun_ = false;
  bool first_ = true;  ///< True at the beginning of a round.
  Timestamp epoch_{};  ///< When the round began.
  Duration position_{0};
};

}  // namespace chorus::camera

// When each picture of a video file is due, at the file's own rate.  Pure.
//
// A file that loops begins its rounds at whole multiples of its length since 1970, so that several
// sensors that loop videos of one length show them in step, without knowing of each other.
#pragma once

#include <optional>

#include "common/base/duration.h"
#include "common/time/timestamp.h"

namespace chorus::camera {

struct FileTiming {
  Duration step{0};                  ///< Between two pictures.
  std::optional<Duration> length{};  ///< Of the whole file; none: not known.
};

class FilePace {
 public:
  explicit FilePace(bool loop) : loop_(loop) {}

  /// The file has been opened, for the first time or again.  Returns which part of it is over.
  [[nodiscard]] Duration begin(const FileTiming& timing, Timestamp now);
  /// When the next picture is due.  `position`: in the file, where the file tells.
  [[nodiscard]] Timestamp due(std::optional<Duration> position);
  /// The next picture comes that much later, because reading it took too long.
  void fall_behind(Duration by) { epoch_ += by; }

 private:
  bool loop_;
  FileTiming timing_;
  bool begun_ = false;
  bool first_ = true;  ///< Of a round.
  Timestamp epoch_{};  ///< When the round began.
  Duration position_{0};
};

}  // namespace chorus::camera

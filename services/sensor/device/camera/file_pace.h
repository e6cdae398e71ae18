// When each picture of a video file is due, at the file's own rate.  Pure.
//
// A looping file begins its rounds at whole multiples of its length since 1970, so that several
// sensors that loop videos of one length show them in step without knowing of one another.
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

  /// Called when the file has been opened, even again.  Returns how much of it is already over.
  [[nodiscard]] Duration begin(const FileTiming& timing, Timestamp now);
  /// When the next picture is due.  `position`: its time in the file, if the file has one.
  [[nodiscard]] Timestamp due(std::optional<Duration> position);
  /// Delays the next picture by this much, because reading it took too long.
  void fall_behind(Duration by) { epoch_ += by; }

 private:
  bool loop_;
  FileTiming timing_;
  bool begun_ = false;
  bool first_ = true;  ///< At the beginning of a round.
  Timestamp epoch_{};  ///< When the round began.
  Duration position_{0};
};

}  // namespace chorus::camera

// Counts what arrives from one sensor; no input can make a count negative or a rate absurd.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/sensor/sensor_frame.h"

namespace chorus::poll {

class FrameTally {
 public:
  void note(const SensorFrame& frame);
  /// A frame that came after a newer one: counted as missed until now.
  void note_late(const SensorFrame& frame);

  /// Frames per second that arrived lately, by our clock.
  [[nodiscard]] double rate_hz(Timestamp now) const;
  [[nodiscard]] std::optional<Timestamp> newest() const noexcept { return newest_; }
  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  void arrived(Timestamp received);

  std::deque<Timestamp> arrivals_;  ///< Of the last two seconds.
  std::optional<Timestamp> first_;  ///< Arrival since the last pause.
  std::optional<Timestamp> newest_;
  std::optional<std::uint64_t> last_sequence_;
  std::uint64_t frames_ = 0;
  std::uint64_t missed_ = 0;
};

/// Notices a frame whose time does not fit the earlier ones: perhaps a clock was set.
class AgeWatch {
 public:
  /// Its age does not fit, from capture to receipt as the clocks are known; or it was captured
  /// before the frame that it follows.
  [[nodiscard]] bool odd(const SensorFrame& frame);

 private:
  [[nodiscard]] bool strange(const SensorFrame& frame) const;

  std::deque<Duration> ages_;
  std::uint64_t sequence_ = 0;  ///< Of the frame before.
  Timestamp captured_{};
  int odd_in_row_ = 0;
};

}  // namespace chorus::poll

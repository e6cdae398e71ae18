// Counts what one source delivers; no input can make a count negative or a rate implausible.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/client/answer.h"

namespace chorus::client {

class FrameTally {
 public:
  void note(const Dated& frame);
  /// Counts a frame that arrived after a newer one; until now it was counted as missed.
  void note_late(const Dated& frame);

  /// Rate at which frames arrived recently [Hz], by our clock.
  [[nodiscard]] double rate_hz(Timestamp now) const;
  [[nodiscard]] std::optional<Timestamp> newest() const noexcept { return newest_; }
  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  void arrived(Timestamp received);

  std::deque<Timestamp> arrivals_;  ///< Times of arrival, of the last two seconds.
  std::optional<Timestamp> first_;  ///< First arrival since the last pause.
  std::optional<Timestamp> newest_;
  std::optional<std::uint64_t> last_sequence_;
  std::uint64_t frames_ = 0;
  std::uint64_t missed_ = 0;
};

/// Detects a frame whose time does not fit those of earlier frames: perhaps a clock was set.
class AgeWatch {
 public:
  /// True if the frame's age (capture to receipt, as far as the clocks are known) does not fit, or
  /// if it was captured before the frame before it. False until the ages of some frames are known.
  [[nodiscard]] bool odd(const Dated& frame);

 private:
  [[nodiscard]] bool strange(const Dated& frame) const;

  std::deque<Duration> ages_;
  std::uint64_t sequence_ = 0;  ///< The previous frame's sequence.
  Timestamp captured_{};
  int odd_in_row_ = 0;
};

}  // namespace chorus::client

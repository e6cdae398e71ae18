#include "fusion-server/poll/frame_tally.h"

#include <algorithm>

namespace chorus::poll {
namespace {

constexpr Duration kWindow = std::chrono::seconds(2);
constexpr Duration kLeastSpan = std::chrono::milliseconds(500);
constexpr Duration kPause = std::chrono::seconds(1);  ///< Longer, and a rate begins anew.
constexpr std::uint64_t kMostGap = 900;               ///< Half a minute; beyond, it counts anew.

constexpr std::size_t kAges = 32;
constexpr std::size_t kLeastAges = 8;
constexpr Duration kEarlier = std::chrono::milliseconds(20);
constexpr Duration kLater = std::chrono::milliseconds(300);
constexpr int kNewHabit = 4;  ///< Odd ones in a row that are the rule from now on.

}  // namespace

void FrameTally::arrived(Timestamp received) {
  ++frames_;
  const bool anew =
      arrivals_.empty() || received < arrivals_.back() || received - arrivals_.back() > kPause;
  if (anew) {
    arrivals_.clear();
    first_ = received;
  }
  arrivals_.push_back(received);
  while (received - arrivals_.front() > kWindow) arrivals_.pop_front();
}

void FrameTally::note(const SensorFrame& frame) {
  arrived(frame.received);
  newest_ = frame.captured;
  if (last_sequence_ && frame.sequence > *last_sequence_) {
    const std::uint64_t gap = frame.sequence - *last_sequence_ - 1;
    if (gap <= kMostGap) missed_ += gap;
  }
  last_sequence_ = frame.sequence;
}

void FrameTally::note_late(const SensorFrame& frame) {
  arrived(frame.received);
  if (missed_ > 0) --missed_;
}

double FrameTally::rate_hz(Timestamp now) const {
  if (!first_ || arrivals_.empty() || now - arrivals_.back() > kPause) return 0.0;
  const auto lately = std::lower_bound(arrivals_.begin(), arrivals_.end(), now - kWindow);
  const Duration span = std::clamp(now - *first_, kLeastSpan, kWindow);
  return static_cast<double>(arrivals_.end() - lately) / seconds(span);
}

bool AgeWatch::odd(Duration age) {
  const auto [least, most] = std::minmax_element(ages_.begin(), ages_.end());
  const bool strange =
      ages_.size() >= kLeastAges && (age < *least - kEarlier || age > *most + kLater);
  odd_in_row_ = strange ? odd_in_row_ + 1 : 0;
  if (odd_in_row_ >= kNewHabit) ages_.clear();
  if (!strange || ages_.empty()) ages_.push_back(age);
  if (ages_.size() > kAges) ages_.pop_front();
  return strange;
}

}  // namespace chorus::poll

#include "common/client/frame_tally.h"

#include <algorithm>

namespace chorus::client {
namespace {

constexpr Duration kWindow = std::chrono::seconds(2);
constexpr Duration kMinSpan = std::chrono::milliseconds(500);
/// After a pause longer than this, the rate is 0; it is computed anew once frames come again.
constexpr Duration kPause = std::chrono::seconds(1);
/// As many frames as come in half a minute at 30 Hz.  A larger gap in the sequence means that the
/// sensor started again: its frames do not count as missed.
constexpr std::uint64_t kMaxGap = 900;

constexpr std::size_t kAges = 32;
constexpr std::size_t kMinAges = 8;
constexpr Duration kEarlier = std::chrono::milliseconds(20);
constexpr Duration kLater = std::chrono::milliseconds(300);
constexpr int kNewHabit = 4;  ///< This many odd frames in a row are taken for the new normal.

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

void FrameTally::note(const Dated& frame) {
  arrived(frame.received);
  newest_ = frame.captured;
  if (last_sequence_ && frame.sequence > *last_sequence_) {
    const std::uint64_t gap = frame.sequence - *last_sequence_ - 1;
    if (gap <= kMaxGap) missed_ += gap;
  }
  last_sequence_ = frame.sequence;
}

void FrameTally::note_late(const Dated& frame) {
  arrived(frame.received);
  if (missed_ > 0) --missed_;
}

double FrameTally::rate_hz(Timestamp now) const {
  if (!first_ || arrivals_.empty() || now - arrivals_.back() > kPause) return 0.0;
  const auto lately = std::lower_bound(arrivals_.begin(), arrivals_.end(), now - kWindow);
  const Duration span = std::clamp(now - *first_, kMinSpan, kWindow);
  return static_cast<double>(arrivals_.end() - lately) / seconds(span);
}

bool AgeWatch::strange(const Dated& frame) const {
  if (ages_.size() < kMinAges) return false;
  const auto [least, most] = std::ranges::minmax(ages_);
  const Duration age = frame.received - frame.captured;
  const bool backwards = frame.sequence > sequence_ && frame.captured < captured_;
  return backwards || age < least - kEarlier || age > most + kLater;
}

bool AgeWatch::odd(const Dated& frame) {
  const bool odd = strange(frame);
  odd_in_row_ = odd ? odd_in_row_ + 1 : 0;
  if (odd_in_row_ >= kNewHabit) ages_.clear();
  if (!odd || ages_.empty()) ages_.push_back(frame.received - frame.captured);
  if (ages_.size() > kAges) ages_.pop_front();
  sequence_ = frame.sequence;
  captured_ = frame.captured;
  return odd;
}

}  // namespace chorus::client

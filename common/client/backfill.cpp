#include "common/client/backfill.h"

namespace chorus::client {
namespace {

constexpr std::uint64_t kMaxMissing = 90;  ///< Sensors keep three seconds of frames.
constexpr Duration kWorthwhile = std::chrono::milliseconds(700);  ///< Older frames are of no use.
constexpr int kMaxInVain = 8;

}  // namespace

void Backfill::saw(std::uint64_t sequence, Duration now) {
  const bool follows = last_ && sequence > *last_;
  const std::uint64_t gap = follows ? sequence - *last_ - 1 : 0;
  // The stream is of another run, or more frames are missing than sensors keep.
  if (!follows || gap > kMaxMissing) missing_.clear();
  if (follows && gap <= kMaxMissing && in_vain_ < kMaxInVain) {
    for (std::uint64_t lost = *last_ + 1; lost < sequence; ++lost) missing_.push_back({lost, now});
    while (missing_.size() > kMaxMissing) missing_.pop_front();
  }
  last_ = sequence;
}

std::optional<std::uint64_t> Backfill::next(Duration now) {
  while (!missing_.empty()) {
    const Gap gap = missing_.front();
    missing_.pop_front();
    if (now - gap.noticed <= kWorthwhile) return gap.sequence;
  }
  return std::nullopt;
}

void Backfill::answered(bool there) {
  in_vain_ = there ? 0 : in_vain_ + 1;
  if (in_vain_ >= kMaxInVain) missing_.clear();
}

void Backfill::restart() { *this = Backfill(); }

}  // namespace chorus::client

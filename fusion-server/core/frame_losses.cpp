#include "fusion-server/core/frame_losses.h"

#include <cstdint>

#include "fusion-server/core/last_seen.h"

namespace chorus::core {
namespace {

constexpr std::string_view kOutOfOrder =
    "a frame was captured before the one it follows, and is refused: the clock of the sensor's "
    "host "
    "was set back, or it numbers its frames wrongly";
constexpr std::string_view kFuture =
    "a frame was captured in the future, and is refused: set the clock of the sensor's host";
constexpr std::string_view kStaleFrame =
    "a frame came more than a second after later ones, and is refused: its network or the program "
    "that sends it holds frames back";

}  // namespace

bool FrameLosses::count(const SensorFrame& frame, align::PushVerdict verdict) {
  using align::PushVerdict;
  const auto leave_out = [&](std::uint64_t& fate, std::string_view why) {
    ++fate;
    refuse(frame, why);
    return false;
  };
  switch (verdict) {
    case PushVerdict::Added:
      return true;
    case PushVerdict::Late:
      return ++counts_.late > 0;
    case PushVerdict::Restarted:
      return ++counts_.restarts > 0;
    case PushVerdict::Duplicate:
      ++counts_.doubled;
      return false;
    case PushVerdict::Stale:
      return leave_out(counts_.stale, kStaleFrame);
    case PushVerdict::Backwards:
      return leave_out(counts_.backwards, kOutOfOrder);
    case PushVerdict::Future:
      return leave_out(counts_.early, kFuture);
  }
  return false;
}

void FrameLosses::refuse(const SensorFrame& frame, std::string_view why) {
  last_ = frame.received;
  why_ = why;
}

std::string FrameLosses::complaint(Timestamp now) const {
  const bool lately = !why_.empty() && now - last_ < kSeenLately;
  return lately ? std::string(why_) : std::string();
}

}  // namespace chorus::core

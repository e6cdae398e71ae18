#include "fusion-server/core/fates.h"

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

bool Fates::count(const SensorFrame& frame, align::PushVerdict verdict) {
  using align::PushVerdict;
  FrameFates& fates = refused_[frame.sensor].fates;
  const auto leave_out = [&](std::uint64_t& fate, std::string_view why) {
    ++fate;
    refuse(frame, why);
    return false;
  };
  switch (verdict) {
    case PushVerdict::Added:
      return true;
    case PushVerdict::Late:
      return ++fates.late > 0;
    case PushVerdict::Restarted:
      return ++fates.restarts > 0;
    case PushVerdict::Duplicate:
      ++fates.doubled;
      return false;
    case PushVerdict::Stale:
      return leave_out(fates.stale, kStaleFrame);
    case PushVerdict::Backwards:
      return leave_out(fates.backwards, kOutOfOrder);
    case PushVerdict::Future:
      return leave_out(fates.early, kFuture);
  }
  return false;
}

void Fates::refuse(const SensorFrame& frame, std::string_view why) {
  refused_[frame.sensor].last = frame.received;
  refused_[frame.sensor].why = why;
}

void Fates::keep(const std::set<SensorId>& sensors) {
  std::erase_if(refused_, [&](const auto& entry) { return !sensors.contains(entry.first); });
}

FrameFates Fates::of(const SensorId& sensor) const {
  const auto it = refused_.find(sensor);
  return it == refused_.end() ? FrameFates{} : it->second.fates;
}

std::string Fates::complaint(const SensorId& sensor, Timestamp now) const {
  const auto it = refused_.find(sensor);
  const bool lately = it != refused_.end() && now - it->second.last < kSeenLately;
  return lately ? std::string(it->second.why) : std::string();
}

}  // namespace chorus::core

#include "fusion-server/nats/site_look.h"

#include <algorithm>

namespace chorus::nats {
namespace {

/// A larger step back is a clock that was set: frames follow it.
constexpr Duration kLateFrame = std::chrono::seconds(1);
constexpr Duration kLeastStep = std::chrono::microseconds(1);

}  // namespace

std::shared_ptr<const Snapshot> SiteLook::show(std::span<const site::SitePerson> people,
                                               const LookAt& look) {
  sequence_ = std::max(sequence_ + 1, look.cell->sequence);
  Timestamp at = look.cell->instant + look.since;
  if (look.place) at += look.place->clock_added;
  if (at <= at_ && at_ - at < kLateFrame) at = at_ + kLeastStep;
  at_ = at;
  const std::vector<site::ShownPerson> shown = showing_.show(people, at);
  return std::make_shared<const Snapshot>(
      site_snapshot({shown, own_, look.place, sequence_, at}, *look.cell, seats_));
}

}  // namespace chorus::nats

// Internal: what our cell shows of its site, one frame after another.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "fusion-server/nats/site_snapshot.h"

namespace chorus::nats {

/// When a frame is made: with a snapshot of our own cell, or later, because a neighbour told.
struct LookAt {
  std::shared_ptr<const Snapshot> cell;  ///< Our own cell's newest.
  Duration since{0};                     ///< For how long we have had it.
  std::optional<site::CellPlace> place;  ///< Of our own cell.
};

class SiteLook {
 public:
  SiteLook(site::CellId own, const site::SiteConfig& config)
      : own_(std::move(own)), showing_(config) {}

  /// Of the instant of our cell's snapshot, later by LookAt::since, so that frames follow one
  /// another as our own do.  Sequence and instant grow with each frame, and the sequence is never
  /// below that of the cell's snapshot, so that it grows across restarts, too.
  [[nodiscard]] std::shared_ptr<const Snapshot> show(std::span<const site::SitePerson> people,
                                                     const LookAt& look);

 private:
  site::CellId own_;
  site::Showing showing_;
  SiteSeats seats_;
  std::uint64_t sequence_ = 0;
  Timestamp at_;
};

}  // namespace chorus::nats

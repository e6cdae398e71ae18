// Everybody in the site as one snapshot, for /site/frame and for outputs that show the site.
//
// The site's space and time, at one instant (site/shown.h).  Snapshot::sensors are the cells, and a
// joint's contributor is the cell that it comes from.  People of our own cell are complete; of
// others we know the joints that their cells tell, without orientations.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "fusion-server/flow/snapshot.h"
#include "fusion-server/site/shown.h"

namespace chorus::nats {

/// The number of a site id in frames and outputs, from 1, the same in every cell; below 2^52, so
/// that JavaScript can read it.
[[nodiscard]] PersonId number_of(const site::SiteId& id);

/// Seats of people in outputs: the lowest free one, kept while the person is in the site and for
/// ten seconds after, so that nobody else takes it at once.
class SiteSeats {
 public:
  [[nodiscard]] std::size_t seat(const site::SiteId& id, Timestamp now);

 private:
  struct Seat {
    std::size_t number = 0;
    Timestamp last;
  };
  std::map<site::SiteId, Seat> taken_;
};

/// What a site's snapshot is made of.
struct SiteScene {
  std::span<const site::ShownPerson> people;
  site::CellId own;
  std::optional<site::CellPlace> place;  ///< Of our own cell; none: nobody of it is in `people`.
  std::uint64_t sequence = 0;
  Timestamp at;  ///< The instant of all of them, by the site's clock.
};

/// `cell`: the newest snapshot of our own cell.
[[nodiscard]] Snapshot site_snapshot(const SiteScene& scene, const Snapshot& cell,
                                     SiteSeats& seats);

}  // namespace chorus::nats

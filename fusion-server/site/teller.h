// What our own cell tells of its people, from the snapshots that its pipeline publishes.
#pragma once

#include <map>

#include "fusion-server/flow/snapshot.h"
#include "fusion-server/site/cell_people.h"

namespace chorus::site {

/// Remembers since when each person has been published, and the lengths between their joints.
class Teller {
 public:
  Teller(CellId cell, std::uint64_t boot) : cell_(std::move(cell)), boot_(boot) {}

  /// The people of the snapshot; those whose pelvis is not seen are left out.  Without site ids:
  /// Site::decide() says them, and name() enters them.
  [[nodiscard]] CellPeople tell(const Snapshot& snapshot);

 private:
  struct Known {
    Timestamp since;
    Timestamp last;
    associate::Build build;
  };
  CellId cell_;
  std::uint64_t boot_;
  std::map<PersonId, Known> known_;
};

struct Decision;
/// Enters the site ids that were decided into what our cell publishes.
void name(CellPeople& people, const Decision& decision);

}  // namespace chorus::site

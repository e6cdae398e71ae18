// What a hall is without a site: one fusion server over all cells, or each cell for itself.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fusion-server/associate/person_association.h"
#include "tests/bench/site/crossings.h"
#include "tests/judge/hall.h"
#include "tests/judge/identity.h"

namespace chorus::bench {

/// One answer for the whole hall at one instant.
struct HallAnswer {
  std::vector<SeenAs> seen;     ///< By cell and person.
  std::vector<Claimed> people;  ///< Each once, as a client would read them; ids by number.
};

/// A fusion server whose sensors are the cells: the association of a cell, as it is, with the
/// places that the site believes.  No body has to wait because another cell does not see it.
class Cascade {
 public:
  [[nodiscard]] HallAnswer at(const Hall& hall);

 private:
  associate::Tracks tracks_;
};

/// Every cell's ids, as they are.
[[nodiscard]] HallAnswer cells_alone(const Hall& hall);

/// What the site says: of each cell's people, and of everybody as the first cell knows them.
class OverSite {
 public:
  [[nodiscard]] HallAnswer at(Hall& hall);

 private:
  std::map<std::string, std::uint64_t> numbers_;
};

}  // namespace chorus::bench

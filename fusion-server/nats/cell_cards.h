// Internal: what the cells of the site say of themselves, the newest of each.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/nats/cell_records.h"
#include "fusion-server/site/site_view.h"

namespace chorus::nats {

class CellCards {
 public:
  /// Whether it is newer than what is known of the cell; the store may tell an older card than the
  /// cell itself.  TooLarge: there are more cells than a site has.
  [[nodiscard]] Result<bool> hear(const CellCard& card);

  /// The cells that the core knows, with what they say; `own`: our own card.
  [[nodiscard]] std::vector<site::KnownCell> known(const std::vector<site::CellState>& cells,
                                                   const CellCard& own) const;

 private:
  std::map<site::CellId, CellCard> cards_;
};

}  // namespace chorus::nats

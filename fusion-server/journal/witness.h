// Says what happened between two glimpses of the tracker.  Pure: it keeps the last glimpse.
#pragma once

#include <optional>
#include <vector>

#include "fusion-server/journal/event.h"
#include "fusion-server/journal/glimpse.h"

namespace chorus::journal {

class Witness {
 public:
  /// The events since the last glimpse, without ids.  The first glimpse tells only of what is wrong
  /// already.
  [[nodiscard]] std::vector<Event> compare(Glimpse now);

 private:
  std::optional<Glimpse> last_;
  bool disk_told_ = false;  ///< That it is nearly full.
};

/// Every kind of event that there is, for tests of the contract.
[[nodiscard]] const std::vector<std::string_view>& kinds_of_events();

}  // namespace chorus::journal

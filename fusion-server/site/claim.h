// Which cell answers for a person: a record of the store that all cells share, under the key
// "person.SITEID", changed by compare-and-set only.
//
// The store numbers every change of a key.  A cell writes with the number that it knows, and is
// refused if another cell has written since.  Without a store nobody answers a request; every cell
// then answers for the people it sees (ownership.h).  The store forgets a record an hour after its
// last change; whoever wants the person then asks as if there had been none.
#pragma once

#include <cstdint>
#include <optional>

#include "fusion-server/site/site_id.h"

namespace chorus::site {

enum class ClaimState {
  Held,      ///< The cell answers for the person.
  Released,  ///< It has lost sight of the person; whoever sees them may claim them at once.
  Joined,    ///< The id is an alias of `same_as`; nobody bears it any more.
};

/// The record of one person.
struct Claim {
  SiteId id;
  CellId cell;
  std::uint64_t revision = 0;  ///< By the store; larger after each change.
  ClaimState state = ClaimState::Held;
  std::optional<SiteId> same_as = {};  ///< Of Joined.
};

/// A write that the cell wants.  The rim carries it out and reports with ClaimResult, or reports
/// nothing if the store does not answer; it is asked again for after a second.
struct ClaimRequest {
  Claim value;                 ///< `revision` is of no meaning.
  std::uint64_t expected = 0;  ///< The revision that is to be replaced; 0: there is no such key.
};

struct ClaimResult {
  /// The record after the request, whoever wrote it.  Revision 0: the store has none any more,
  /// because it keeps records for a time only.
  Claim now;
  bool accepted = false;
};

}  // namespace chorus::site

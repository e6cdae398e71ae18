// Our people against those of one other cell.
#pragma once

#include "fusion-server/site/heard_cell.h"

namespace chorus::site {

/// What of a person besides their place counts when they are matched.
struct KnownName {
  SiteId id;          ///< Empty: not named.
  bool sure = false;  ///< The name is not doubtful.
};
/// The names in use: of our bodies, and, for those of another cell, what SiteId::present() makes
/// of what it tells.
struct NamesInUse {
  std::map<PersonId, KnownName> ours;
  std::map<PersonId, KnownName> theirs;
};

/// When it is, and by which rules.
struct Moment {
  const SiteConfig& config;
  Timestamp now;
};

/// Takes what both cells saw since the last call into the windows of `theirs`.
void sample_pairs(const HeardCell& ours, HeardCell& theirs);

/// Sets theirs.likely.
void match_cells(const HeardCell& ours, HeardCell& theirs, const NamesInUse& names,
                 const Moment& moment);

/// Learns the common error and how well lengths repeat from the people who bear one name in both
/// cells and are where they should be; at most once a second.
void learn_from_matches(const HeardCell& ours, HeardCell& theirs, const NamesInUse& names,
                        const Moment& moment);

/// The probability that the two are one person, as match_cells() found it.
[[nodiscard]] double likely_pair(const HeardCell& theirs, const BodyPair& pair);
/// For how long both bodies have been seen together, within the window [s].
[[nodiscard]] double seen_together(const HeardCell& theirs, const BodyPair& pair);

}  // namespace chorus::site

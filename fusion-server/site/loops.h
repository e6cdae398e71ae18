// Loops of cells: whether the links of cells, followed around a loop, lead back to where they
// began.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion-server/flow/pairwise_registration.h"
#include "fusion-server/site/site_id.h"

namespace chorus::site {

/// A loop of three cells or more.
struct CellLoop {
  std::vector<CellId> cells;
  double closure = 0.0;   ///< How far the point where the loop began is from itself [m].
  double expected = 0.0;  ///< Standard deviation of that, from the links' covariances [m].
};

/// One loop for each link that a spanning tree of the shortest links leaves out.
[[nodiscard]] std::vector<CellLoop> loops_of(const std::vector<PairwiseRegistration>& links);

struct LoopLimits {
  double sigmas = 3.5;
  double least = 0.10;  ///< [m]
};
[[nodiscard]] bool closes(const CellLoop& loop, const LoopLimits& limits);

/// The cell that does not fit: without its links every loop that is left closes, and no other
/// cell's absence does so.  None: all loops close.  Where several would do, that of the largest
/// open loops and of the fewest that close, and `alone` is false.
struct Misfit {
  CellId cell;
  bool alone = true;
  CellLoop worst;
};
[[nodiscard]] std::optional<Misfit> misfit_of(const std::vector<PairwiseRegistration>& links,
                                              const LoopLimits& limits);

}  // namespace chorus::site

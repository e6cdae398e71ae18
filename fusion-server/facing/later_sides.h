// What later instants say about a person's sides at earlier ones: the backward half of the model of
// person_sides.h.
//
// With a_t the weights of the forward filter, l_t the likelihoods and T_t the transitions of an
// instant (docs/papers/sides.md, Afterwards):
//   b_n = 1,   b_(t-1) = T_t (l_t b_t),   P_t in proportion to a_t b_t
// each in the names of its own instant: where the held sides were turned round, signs change
// places.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fusion-server/facing/person_sides.h"
#include "fusion-server/flow/person.h"

namespace chorus::facing {

/// For each instant, the probability that the sides that were held after it are right, given all of
/// `steps`, which are one person's in order of time.  After a gap (SidesStep::first) the person may
/// have either side: nothing is passed on across it.
[[nodiscard]] std::vector<double> right_afterwards(std::span<const SidesStep> steps);

/// Whether the sides that were held after `step` are to be exchanged, if they are right with the
/// probability `right` (right_afterwards()): only if the log odds against them exceed `change_odds`
/// (SidesConfig), as the filter itself changes sides.  `before`: whether those of the person's
/// instant before were exchanged; then they stay so while the odds are against the held ones at
/// all. Otherwise what is in doubt would change from instant to instant.
[[nodiscard]] bool exchanged_afterwards(const SidesStep& step, double right,
                                        std::optional<bool> before, double change_odds);

/// Swaps left and right in all views of a person whose sides were resolved the wrong way round, and
/// turns `facing` to match.  Orientations are lost, because they describe the body as it was
/// labelled.
void exchange_sides(Person& person);

}  // namespace chorus::facing

// Internal: a cell that the solver left out may still fit to those that have a place.
//
// The solver finds clocks pair by pair.  Where two cells share little of the walk, such a clock may
// be wrong by so much that their places contradict those of others.  Here all cells with a place
// say together which clock fits.
#pragma once

#include <optional>
#include <span>

#include "fusion-server/site/joint_places.h"

namespace chorus::site {

/// Where joint_places() may begin for the cell of `path`: at the clock at which what it saw fits
/// best to what the cells with a place saw.  None: they saw too little of the walk together, or it
/// fits at no clock, as where a cell saw somebody else, in a mirror, or was moved.
[[nodiscard]] std::optional<CellPlace> place_beside(const CellPath& path,
                                                    std::span<const CellPath> paths,
                                                    std::span<const CellPlace> placed);

}  // namespace chorus::site

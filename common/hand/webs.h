// Convexity defects of an outline: steps 1 and 2 of 4.1.
#pragma once

#include <vector>

#include "common/hand/hand.h"

namespace chorus::hand {

struct Defect {
  std::size_t start = 0;  ///< Indices on the outline: both ends of the hull's edge, ...
  std::size_t end = 0;
  std::size_t far = 0;  ///< ... and the deepest point between them.
  double depth = 0.0;   ///< [px]
};

/// In the outline's order; empty for an outline that has none.
[[nodiscard]] std::vector<Defect> defects_of(const Outline& outline);

}  // namespace chorus::hand

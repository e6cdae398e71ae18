// Otto's Figs. 5-8 and Table 1 reproduced with our sensor, with the paper's values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::bench {

/// One scenario of Table 1: the range over our set-ups, and the paper's value.
struct TableOneBar {
  double angle_deg = 0.0;
  double least = 0.0, median = 0.0, most = 0.0;  ///< [mm]
  double otto = 0.0;                             ///< [mm]
};

/// Writes mannequin-yaw, -shoulders, -jitter, -circle and -errors as SVG into this folder, and
/// table1 if `table1` is not empty.
[[nodiscard]] Result<void> draw_figures(const std::string& folder, std::uint64_t seed,
                                        const std::vector<TableOneBar>& table1);

}  // namespace chorus::bench

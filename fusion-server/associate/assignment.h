// One-to-one assignment of rows to columns at the lowest total cost (Hungarian method, O(r^2 c)
// where r is the shorter side).
#pragma once

#include <limits>
#include <optional>
#include <vector>

namespace chorus::associate {

/// Costs, row by row; a pair whose cost exceeds `gate`, or is NaN, is never made.
struct CostTable {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> cost;
  double gate = 0.0;
  /// Cost of leaving a row or column of the shorter side unpaired; infinite: as many allowed pairs
  /// as possible are made.
  double unpaired = std::numeric_limits<double>::infinity();

  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return cost[row * columns + column];
  }
};

/// The column assigned to each row; none if the row is unpaired.
[[nodiscard]] std::vector<std::optional<std::size_t>> assign(const CostTable& table);

}  // namespace chorus::associate

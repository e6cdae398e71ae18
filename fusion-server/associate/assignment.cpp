#include "fusion-server/associate/assignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chorus::associate {
namespace {

constexpr std::size_t kFree = 0;  // Rows and columns are counted from one; 0: unassigned.

/// Shortest augmenting paths with potentials. The shorter side becomes the rows, so that every row
/// gets a column. A forbidden pair costs CostTable::unpaired or, if that is infinite, more than all
/// allowed pairs together.
class Hungarian {
 public:
  explicit Hungarian(const CostTable& table)
      : table_(table),
        turned_(table.rows > table.columns),
        rows_(std::min(table.rows, table.columns)),
        columns_(std::max(table.rows, table.columns)),
        forbidden_(std::isfinite(table.unpaired)
                       ? table.unpaired
                       : (table.gate + 1.0) * static_cast<double>(columns_ + 1)),
        row_potential_(rows_ + 1, 0.0),
        column_potential_(columns_ + 1, 0.0),
        row_of_(columns_ + 1, kFree) {
    for (std::size_t row = 1; row <= rows_; ++row) add(row);
  }

  /// Calls `take(row, column)` for each pair, with the table's indices.
  template <class Take>
  void visit(const Take& take) const {
    for (std::size_t column = 1; column <= columns_; ++column) {
      const std::size_t row = row_of_[column];
      if (row == kFree) continue;
      turned_ ? take(column - 1, row - 1) : take(row - 1, column - 1);
    }
  }

 private:
  [[nodiscard]] double cost(std::size_t row, std::size_t column) const {
    const double c = turned_ ? table_.at(column - 1, row - 1) : table_.at(row - 1, column - 1);
    return c <= table_.gate ? c : forbidden_;
  }

  void add(std::size_t row) {
    slack_.assign(columns_ + 1, std::numeric_limits<double>::infinity());
    came_from_.assign(columns_ + 1, kFree);
    visited_.assign(columns_ + 1, false);
    row_of_[kFree] = row;
    std::size_t column = kFree;
    while (row_of_[column] != kFree) column = step(column);
    while (column != kFree) {
      const std::size_t previous = came_from_[column];
      row_of_[column] = row_of_[previous];
      column = previous;
    }
  }

  /// Visits `column`, updates the slack of all columns, and returns the unvisited column with the
  /// least slack.
  std::size_t step(std::size_t column) {
    visited_[column] = true;
    const std::size_t row = row_of_[column];
    std::size_t nearest = kFree;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 1; j <= columns_; ++j) {
      if (visited_[j]) continue;
      const double reduced = cost(row, j) - row_potential_[row] - column_potential_[j];
      if (reduced < slack_[j]) {
        slack_[j] = reduced;
        came_from_[j] = column;
      }
      if (slack_[j] < least) {
        least = slack_[j];
        nearest = j;
      }
    }
    for (std::size_t j = 0; j <= columns_; ++j) {
      if (visited_[j]) {
        row_potential_[row_of_[j]] += least;
        column_potential_[j] -= least;
      } else {
        slack_[j] -= least;
      }
    }
    return nearest;
  }

  const CostTable& table_;
  bool turned_;
  std::size_t rows_;
  std::size_t columns_;
  double forbidden_;
  std::vector<double> row_potential_;
  std::vector<double> column_potential_;
  std::vector<std::size_t> row_of_;
  std::vector<double> slack_;
  std::vector<std::size_t> came_from_;
  std::vector<bool> visited_;
};

}  // namespace

std::vector<std::optional<std::size_t>> assign(const CostTable& table) {
  std::vector<std::optional<std::size_t>> column_of(table.rows);
  if (table.rows == 0 || table.columns == 0) return column_of;
  Hungarian(table).visit([&](std::size_t row, std::size_t column) {
    if (table.at(row, column) <= table.gate) column_of[row] = column;
  });
  return column_of;
}

}  // namespace chorus::associate

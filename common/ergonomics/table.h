// The printed tables of the methods, read from the text files in tables/ (which name their
// sources).
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::ergonomics {

/// Up to four dimensions; indices count from 1, as on paper.
class Table {
 public:
  /// Limits each index to the table, so it always answers.
  [[nodiscard]] int at(int a, int b, int c = 1, int d = 1) const {
    const auto limited = [&](int index, std::size_t axis) {
      const int most = static_cast<int>(sizes_[axis]);
      return static_cast<std::size_t>((index < 1 ? 1 : index > most ? most : index) - 1);
    };
    const std::size_t row = limited(a, 0) * sizes_[1] + limited(b, 1);
    return cells_[(row * sizes_[2] + limited(c, 2)) * sizes_[3] + limited(d, 3)];
  }
  [[nodiscard]] const std::array<std::size_t, 4>& sizes() const { return sizes_; }
  [[nodiscard]] const std::vector<int>& cells() const { return cells_; }
  [[nodiscard]] std::vector<int>& cells() { return cells_; }

 private:
  friend Result<std::vector<std::pair<std::string, Table>>> read_tables(std::string_view,
                                                                        std::string_view);
  std::array<std::size_t, 4> sizes_{1, 1, 1, 1};
  std::vector<int> cells_{0};
};

using NamedTables = std::vector<std::pair<std::string, Table>>;

/// Reads "table NAME axis size ..." and its cells; lines with # are comments.  Malformed: a table
/// whose cells are not as many as its sizes say, or no number.  `file` is for messages.
[[nodiscard]] Result<NamedTables> read_tables(std::string_view text, std::string_view file);

/// All tables that come with the program.
struct PrintedTables {
  Table rula_a, rula_b, rula_c;
  Table reba_a, reba_b, reba_c;
  Table owas;
  Table niosh_frequency, niosh_coupling;  ///< In hundredths.
};
[[nodiscard]] const PrintedTables& printed_tables();

}  // namespace chorus::ergonomics

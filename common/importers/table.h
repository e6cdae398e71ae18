// Tables whose first row names the columns, separated by commas, semicolons or tabs.
// A field may be in double quotes, but contain neither quotes nor separators.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/importers/text_rows.h"

namespace chorus::importers {

class Table {
 public:
  /// Reads the first row; refuses an empty file and repeated names.
  [[nodiscard]] static Result<Table> open(LineReader& lines);

  /// Reads the next row; false at the end.  Refuses a row with more or fewer fields than columns.
  [[nodiscard]] Result<bool> next();

  [[nodiscard]] bool has(std::string_view column) const { return columns_.contains(column); }
  /// The field of this row in the column; empty if there is no such column.
  [[nodiscard]] std::string_view field(std::string_view column) const;
  /// The field as a finite number within +-bound; none if the field is empty.
  [[nodiscard]] Result<std::optional<double>> number(std::string_view column, double bound) const;
  /// The field as a whole number of 0 or more; `absent` if the field is empty.
  [[nodiscard]] Result<std::uint64_t> natural(std::string_view column, std::uint64_t absent) const;
  /// A Malformed error for this row, with the column's name and content.
  [[nodiscard]] tl::unexpected<Error> wrong(std::string_view column, std::string_view what) const;

 private:
  explicit Table(LineReader& lines) : lines_(&lines) {}
  void split(std::string_view line);

  LineReader* lines_;
  char separator_ = ',';
  std::map<std::string, std::size_t, std::less<>> columns_;
  std::vector<std::string_view> fields_;
};

}  // namespace chorus::importers

// Reads text formats row by row, up to a size limit; errors name file, line and column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::importers {

inline constexpr std::size_t kShownFieldBytes = 24;  ///< Limit for quoting a wrong field.
inline constexpr std::string_view kBlanks = " \t\r";

/// The text without the blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blanks = kBlanks);

/// Reads a whole file; refuses one that is larger than max_bytes, missing, not a regular file,
/// packed with gzip, or a recording (MCAP).
[[nodiscard]] Result<std::string> read_bounded(const std::filesystem::path& file,
                                               std::uintmax_t max_bytes);

/// Walks through the lines of a string, which must outlive the reader; accepts "\r\n" and a last
/// line without an end.
class LineReader {
 public:
  LineReader(std::string_view text, std::string origin) : rest_(text), origin_(std::move(origin)) {}

  /// The next line, without its line feed (a '\r' before that stays); none at the end of the text.
  [[nodiscard]] std::optional<std::string_view> next();
  /// The next line that is not blank.
  [[nodiscard]] std::optional<std::string_view> next_filled();
  /// A Malformed error whose context is "file:line", with the line that was returned last.
  [[nodiscard]] tl::unexpected<Error> malformed(std::string message) const;

 private:
  std::string_view rest_;
  std::string origin_;
  std::size_t line_ = 0;
};

/// The fields of one row.  With the separator ',', every comma separates two fields, but one at the
/// end of the row is ignored (LabanotationSuite writes one); with ' ', any run of blanks does.
class Row {
 public:
  /// Refuses a row that does not have exactly `expected` fields, such as a truncated one.
  [[nodiscard]] static Result<Row> split(const LineReader& at, std::string_view line,
                                         char separator, std::size_t expected);

  [[nodiscard]] Result<std::int64_t> integer(std::size_t column) const;
  [[nodiscard]] Result<std::uint64_t> natural(std::size_t column) const;
  /// Reads as many finite numbers as `out` holds, from field `first` on, each within +-bound.
  [[nodiscard]] Result<void> numbers(std::size_t first, std::span<double> out, double bound) const;

 private:
  [[nodiscard]] tl::unexpected<Error> wrong(std::size_t column, std::string_view what) const;

  const LineReader* at_ = nullptr;
  std::vector<std::string_view> fields_;
};

}  // namespace chorus::importers

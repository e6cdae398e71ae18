// Columns of a text log with a line of names, as makers' programs write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::inertial {

class TextColumns {
 public:
  /// Skips lines until one begins with a name of `first_columns`; `origin` names the file.  The
  /// lines before it are kept as the preamble.
  [[nodiscard]] static Result<TextColumns> of(
      std::string_view text, std::string_view origin,
      std::initializer_list<std::string_view> first_columns);

  /// The place of the column with this name, if there is one.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<std::string>& preamble() const { return preamble_; }

  /// Moves to the next line that is not empty; false at the end.
  bool next();
  /// Cell i of the line, or "" if it is shorter.
  [[nodiscard]] std::string_view cell(std::size_t i) const {
    return i < cells_.size() ? cells_[i] : std::string_view();
  }
  /// A finite number, or nothing for an empty or unreadable cell.
  [[nodiscard]] std::optional<double> number(std::optional<std::size_t> i) const;
  /// "file:17", for messages.
  [[nodiscard]] std::string where() const { return origin_ + ":" + std::to_string(line_); }

 private:
  bool take_line(std::string_view& line);

  std::string_view rest_;
  std::string origin_;
  char separator_ = ',';
  std::size_t line_ = 0;
  std::vector<std::string> names_, preamble_;
  std::vector<std::string_view> cells_;
};

}  // namespace chorus::inertial

// Output for people: aligned tables, and progress as a bar on a terminal or as plain lines
// elsewhere.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace chorus::ctl {

/// One line, with every control and escape character replaced by "?".
[[nodiscard]] std::string printable(std::string_view text);

/// The strings of an array member, each made printable(); empty when there is no such array.
[[nodiscard]] std::vector<std::string> lines_at(const nlohmann::json& object, const char* key);

/// Indented, with a newline; all characters other than ASCII are escaped.
[[nodiscard]] std::string json_text(const nlohmann::json& value);

/// Columns as wide as their widest cell, separated by two blanks; the first row is the heading.
/// Every cell is made printable().
[[nodiscard]] std::string table(std::vector<std::vector<std::string>> rows);

/// "1.23", or "-" when the number is not finite; never "-0.00".
[[nodiscard]] std::string shown(double value, int digits);

class Progress {
 public:
  /// On a terminal one line is redrawn in place; elsewhere a line is printed at every 10 % and for
  /// every new remark.
  Progress(std::ostream& out, bool terminal, std::string label)
      : out_(out), terminal_(terminal), label_(std::move(label)) {}

  void show(double fraction, std::string_view remark);
  /// Ends the bar's line, so that later output starts on a line of its own.
  void finish();

 private:
  std::ostream& out_;
  const bool terminal_;
  const std::string label_;
  int tenth_ = -1;
  std::string remark_;
  bool drawn_ = false;
};

/// True when standard error is a terminal.
[[nodiscard]] bool on_terminal();

}  // namespace chorus::ctl

#include "common/inertial/text_columns.h"

#include <algorithm>

#include "common/base/parse.h"

namespace chorus::inertial {
namespace {

constexpr std::size_t kMostPreamble = 200;  // lines
constexpr std::size_t kMostColumns = 512;

std::string_view trimmed(std::string_view word) {
  const auto junk = [](char c) { return c == ' ' || c == '\r' || c == '"'; };
  while (!word.empty() && junk(word.front())) word.remove_prefix(1);
  while (!word.empty() && junk(word.back())) word.remove_suffix(1);
  return word;
}

std::vector<std::string_view> parted(std::string_view line, char separator) {
  std::vector<std::string_view> out;
  while (out.size() < kMostColumns) {
    const std::size_t end = std::min(line.find(separator), line.size());
    out.push_back(trimmed(line.substr(0, end)));
    if (end == line.size()) break;
    line.remove_prefix(end + 1);
  }
  return out;
}

char separator_of(std::string_view line) {
  for (const char c : {'\t', ',', ';'})
    if (line.find(c) != std::string_view::npos) return c;
  return ',';
}

}  // namespace

bool TextColumns::take_line(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++line_;
  return true;
}

Result<TextColumns> TextColumns::of(std::string_view text, std::string_view origin,
                                    std::initializer_list<std::string_view> first_columns) {
  TextColumns out;
  out.origin_ = origin;
  out.rest_ = text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
  std::string_view line;
  while (out.preamble_.size() < kMostPreamble && out.take_line(line)) {
    const char separator = separator_of(line);
    const auto words = parted(line, separator);
    if (std::ranges::find(first_columns, words.front()) != first_columns.end()) {
      out.separator_ = separator;
      out.names_.assign(words.begin(), words.end());
      return out;
    }
    out.preamble_.emplace_back(trimmed(line));
  }
  return fail(
      ErrorCode::Malformed, std::string(origin),
      "has no line of column names that begins with " + std::string(*first_columns.begin()));
}

std::optional<std::size_t> TextColumns::column(std::string_view name) const {
  const auto found = std::ranges::find(names_, name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

bool TextColumns::next() {
  std::string_view line;
  while (take_line(line)) {
    if (line.find_first_not_of(" \t\r,;") == std::string_view::npos) continue;
    cells_ = parted(line, separator_);
    return true;
  }
  return false;
}

std::optional<double> TextColumns::number(std::optional<std::size_t> i) const {
  return i ? parse_finite(cell(*i)) : std::nullopt;
}

}  // namespace chorus::inertial

#include "common/importers/table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/not_seen.h"
#include "common/base/parse.h"
#include "common/importers/text_rows.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kMaxColumns = 1024;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The separator that is most frequent in the first row; a comma if none is.
char separator_of(std::string_view header) {
  char best = ',';
  for (const char each : {';', '\t'}) {
    if (std::ranges::count(header, each) > std::ranges::count(header, best)) best = each;
  }
  return best;
}

/// The field without the double quotes around it, which R and Excel write.
std::string_view unquoted(std::string_view field) {
  if (field.size() < 2 || !field.starts_with('"') || !field.ends_with('"')) return field;
  return field.substr(1, field.size() - 2);
}

/// The unit of a column's numbers, which its name ends in, and the mistake that takes them beyond
/// their bound.
std::string_view unit_of(std::string_view column) {
  if (column.ends_with("_mm")) return " mm";
  if (column.ends_with("_m")) return " m; is it in millimetres? Then say --unit mm";
  if (column.ends_with("_s")) return " s; is it in milliseconds?";
  return "";
}

}  // namespace

void Table::split(std::string_view line) {
  fields_.clear();
  while (fields_.size() <= kMaxColumns) {
    const auto end = line.find(separator_);
    fields_.push_back(unquoted(trimmed(line.substr(0, end), " \r")));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

Result<Table> Table::open(LineReader& lines) {
  auto header = lines.next_filled();
  if (!header) return lines.malformed("is empty; its first row has to name the columns.");
  if (header->starts_with(kByteOrderMark)) header->remove_prefix(kByteOrderMark.size());
  Table table(lines);
  table.separator_ = separator_of(*header);
  table.split(*header);
  if (table.fields_.size() > kMaxColumns)
    return lines.malformed(fmt::format("has more than {} columns.", kMaxColumns));
  for (std::size_t i = 0; i < table.fields_.size(); ++i) {
    if (table.fields_[i].empty()) continue;
    if (!table.columns_.emplace(table.fields_[i], i).second)
      return lines.malformed(fmt::format("names the column \"{}\" twice.", table.fields_[i]));
  }
  return table;
}

Result<bool> Table::next() {
  const std::size_t expected = fields_.size();
  const auto line = lines_->next_filled();
  if (!line) return false;
  split(*line);
  if (fields_.size() == expected) return true;
  return lines_->malformed(fmt::format("holds {} values where the first row names {} columns.",
                                       fields_.size(), expected));
}

std::string_view Table::field(std::string_view column) const {
  const auto found = columns_.find(column);
  return found == columns_.end() ? std::string_view() : fields_[found->second];
}

Result<std::optional<double>> Table::number(std::string_view column, double bound) const {
  const std::string_view text = field(column);
  if (is_not_seen(text)) return std::nullopt;
  const auto value = parse_finite(text);
  if (!value && text.find(',') != std::string_view::npos)
    return wrong(column, "is not a number; decimals need a point instead of the comma");
  if (!value) return wrong(column, "is not a number");
  if (std::abs(*value) > bound)
    return wrong(column, fmt::format("is beyond +-{}{}", bound, unit_of(column)));
  return value;
}

Result<std::uint64_t> Table::natural(std::string_view column, std::uint64_t absent) const {
  const std::string_view text = field(column);
  if (text.empty()) return absent;
  const auto value = parse_number<std::uint64_t>(text);
  if (!value) return wrong(column, "is not a whole number of 0 or more");
  return *value;
}

tl::unexpected<Error> Table::wrong(std::string_view column, std::string_view what) const {
  return lines_->malformed(fmt::format("{}: \"{}\" {}{}", column,
                                       field(column).substr(0, kShownFieldBytes), what,
                                       what.ends_with('?') ? "" : "."));
}

}  // namespace chorus::importers

#include "common/importers/text_rows.h"

#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "common/base/file.h"
#include "common/base/parse.h"

namespace chorus::importers {
namespace {

constexpr std::string_view kGzip = "\x1F\x8B";
constexpr std::string_view kMcap = "\x89MCAP";

/// Cuts the next field off `rest`; none when no field is left.
std::optional<std::string_view> cut_field(std::string_view& rest, char separator, bool first) {
  if (separator == ' ') {
    const auto begin = rest.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return std::nullopt;
    rest.remove_prefix(begin);
    const auto field = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(field.size());
    return field;
  }
  if (!first) {
    if (rest.empty()) return std::nullopt;
    rest.remove_prefix(1);  // the separator itself
  }
  const auto field = rest.substr(0, rest.find(separator));
  rest.remove_prefix(field.size());
  return trimmed(field);
}

}  // namespace

std::string_view trimmed(std::string_view text, std::string_view blanks) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

Result<std::string> read_bounded(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  std::error_code failed;
  if (std::filesystem::is_directory(file, failed))
    return fail(ErrorCode::InvalidArgument, file.string(), "is a folder; name the file in it.");
  if (!std::filesystem::is_regular_file(file, failed))
    return fail(ErrorCode::NotFound, file.string(), "there is no such file.");
  auto text = read_file_or_pipe(file, max_bytes).map_error([](Error error) {
    if (error.code == ErrorCode::TooLarge) error.message += ". Cut the recording into parts.";
    return error;
  });
  if (text && text->starts_with(kGzip))
    return fail(ErrorCode::Malformed, file.string(), "is packed with gzip: gunzip it first.");
  if (text && text->starts_with(kMcap))
    return fail(ErrorCode::Malformed, file.string(),
                "is a recording already: chorus fuse and chorus replay read it as it is.");
  return text;
}

std::optional<std::string_view> LineReader::next() {
  if (rest_.empty()) return std::nullopt;
  const auto line = rest_.substr(0, rest_.find('\n'));
  rest_.remove_prefix(std::min(rest_.size(), line.size() + 1));
  ++line_;
  return line;
}

std::optional<std::string_view> LineReader::next_filled() {
  while (const auto line = next()) {
    if (!trimmed(*line).empty()) return line;
  }
  return std::nullopt;
}

tl::unexpected<Error> LineReader::malformed(std::string message) const {
  return fail(ErrorCode::Malformed, line_ == 0 ? origin_ : fmt::format("{}:{}", origin_, line_),
              std::move(message));
}

Result<Row> Row::split(const LineReader& at, std::string_view line, char separator,
                       std::size_t expected) {
  Row row;
  row.at_ = &at;
  std::string_view rest = trimmed(line);
  if (separator != ' ' && rest.ends_with(separator)) rest.remove_suffix(1);
  while (row.fields_.size() <= expected) {
    const auto field = cut_field(rest, separator, row.fields_.empty());
    if (!field) break;
    row.fields_.push_back(*field);
  }
  if (row.fields_.size() > expected)
    return at.malformed(fmt::format("holds more than the {} values of a row.", expected));
  if (row.fields_.size() < expected)
    return at.malformed(fmt::format("holds {} values where {} are needed; is the file cut off?",
                                    row.fields_.size(), expected));
  return row;
}

Result<std::int64_t> Row::integer(std::size_t column) const {
  const auto value = parse_number<std::int64_t>(fields_[column]);
  if (!value) return wrong(column, "is not a whole number");
  return *value;
}

Result<std::uint64_t> Row::natural(std::size_t column) const {
  const auto value = parse_number<std::uint64_t>(fields_[column]);
  if (!value) return wrong(column, "is not a whole number of 0 or more");
  return *value;
}

Result<void> Row::numbers(std::size_t first, std::span<double> out, double bound) const {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto value = parse_number<double>(fields_[first + i]);
    if (!value) return wrong(first + i, "is not a number");
    if (!std::isfinite(*value)) return wrong(first + i, "is not finite");
    if (std::abs(*value) > bound)
      return wrong(first + i, fmt::format("is beyond +-{}; are these metres?", bound));
    out[i] = *value;
  }
  return {};
}

tl::unexpected<Error> Row::wrong(std::size_t column, std::string_view what) const {
  return at_->malformed(fmt::format("value {} (\"{}\") {}.", column + 1,
                                    fields_[column].substr(0, kShownFieldBytes), what));
}

}  // namespace chorus::importers

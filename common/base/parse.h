// Reads numbers from text that others wrote.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace chorus {

/// The number at the beginning of `text`, which is removed from `text`; none, and `text` unchanged,
/// if it does not begin with a number that `Number` can hold.
template <class Number>
[[nodiscard]] std::optional<Number> take_number(std::string_view& text) {
  Number value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

/// The number that the whole string spells: no spaces, no plus sign, nothing after it.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  const auto value = take_number<Number>(text);
  return text.empty() ? value : std::nullopt;
}

/// Like parse_number, but a plus sign is allowed.
template <class Number>
[[nodiscard]] std::optional<Number> parse_signed(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return parse_number<Number>(text);
}

/// A finite number as other programs write it: a plus sign is allowed, and a number too small for a
/// double ("7.6e-400") becomes zero.
[[nodiscard]] inline std::optional<double> parse_finite(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool small =
      error == std::errc::result_out_of_range && text.find_first_of("eE") + 1 == text.find('-', 1);
  if (small && stop == end) return 0.0;
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Reads the number in a resource's name, where each number has only one spelling: "7", not "07".
[[nodiscard]] inline std::optional<std::uint64_t> parse_name_number(std::string_view text) {
  const auto value = parse_number<std::uint64_t>(text);
  return value && std::to_string(*value) == text ? value : std::nullopt;
}

}  // namespace chorus

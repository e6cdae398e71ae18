// Numbers in foreign text: all of it or nothing.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace chorus {

/// The number that the whole text spells, without spaces, signs of plus, or anything behind it.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

/// As in the name of a resource, where each number has one spelling only: "7", not "07".
[[nodiscard]] inline std::optional<std::uint64_t> parse_name_number(std::string_view text) {
  const auto value = parse_number<std::uint64_t>(text);
  return value && std::to_string(*value) == text ? value : std::nullopt;
}

}  // namespace chorus

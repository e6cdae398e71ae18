// Makes strings from outside safe to write: replaces everything that is not UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace chorus::rdf {

/// Number of bytes of the well-formed UTF-8 character at the beginning (Unicode 15, table 3-7); 0
/// if there is none.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

[[nodiscard]] bool is_utf8(std::string_view text);

/// Replaces every byte that is not part of a well-formed character by U+FFFD.
[[nodiscard]] std::string clean_utf8(std::string_view text);

/// The bytes of the string, zero-terminated; valid as long as its c_str().
[[nodiscard]] inline const std::uint8_t* bytes_of(const std::string& text) {
  return reinterpret_cast<const std::uint8_t*>(text.c_str());
}

}  // namespace chorus::rdf

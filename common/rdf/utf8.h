// Text from elsewhere, made safe to write: UTF-8 or replaced.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace chorus::rdf {

/// Bytes of the well-formed UTF-8 character that starts here (Unicode 15, table 3-7); 0 when none
/// does.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

[[nodiscard]] bool is_utf8(std::string_view text);

/// Every byte that belongs to no well-formed character becomes U+FFFD.
[[nodiscard]] std::string clean_utf8(std::string_view text);

}  // namespace chorus::rdf

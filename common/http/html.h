// Escapes strings from outside for use in HTML.
#pragma once

#include <string>
#include <string_view>

namespace chorus::http {

/// Replaces & < > " by entities, so that `text` is safe between tags and in double-quoted
/// attributes.
[[nodiscard]] std::string escaped_html(std::string_view text);

}  // namespace chorus::http

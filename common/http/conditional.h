// Conditional requests and requests to wait: If-None-Match (RFC 9110 13.1.2), Prefer: wait (RFC
// 7240 4.3).
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace chorus::http {

/// True when the list holds `etag` (weak comparison) or is "*".  Empty matches nothing.
[[nodiscard]] bool none_match_lists(std::string_view if_none_match, std::string_view etag);

/// Seconds of "wait=N" in a Prefer field; none when it is absent or not a number.
[[nodiscard]] std::optional<std::chrono::seconds> wait_preference(std::string_view prefer);

}  // namespace chorus::http

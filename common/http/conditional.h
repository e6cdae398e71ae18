// Parses If-None-Match (conditional requests, RFC 9110 13.1.2) and Prefer: wait (long polls, RFC
// 7240 4.3).
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace chorus::http {

/// True when the list contains `etag` (weak comparison) or is "*".  An empty list matches nothing.
[[nodiscard]] bool none_match_lists(std::string_view if_none_match, std::string_view etag);

/// Seconds of "wait=N" in a Prefer field, at most a day; none when it is absent or not a number.
[[nodiscard]] std::optional<std::chrono::seconds> wait_preference(std::string_view prefer);

}  // namespace chorus::http

// Content negotiation: chooses what to send by the Accept header (RFC 9110 12.5.1).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace chorus::http {

/// "text/turtle; charset=utf-8" -> "text/turtle".
[[nodiscard]] std::string_view without_parameters(std::string_view media_type);

/// The quality, from 0 to 1000, that the most specific matching range of `accept` gives to a type;
/// none when no range matches.  Elements that are not media ranges are skipped; parameters other
/// than q are ignored.
[[nodiscard]] std::optional<int> quality_of(std::string_view media_type, std::string_view accept);

/// Like quality_of, but counts only ranges that name the full type, not "*/*" or "text/*".
[[nodiscard]] std::optional<int> explicit_quality_of(std::string_view media_type,
                                                     std::string_view accept);

/// Index of the best offer; of equally good ones, the first.  It is 0 if `accept` contains no media
/// range, and none if no offer is acceptable.
[[nodiscard]] std::optional<std::size_t> negotiate(std::span<const std::string_view> offers,
                                                   std::string_view accept);

}  // namespace chorus::http

// Content negotiation: the Accept header against what a server has (RFC 9110 12.5.1).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace chorus::http {

/// "text/turtle; charset=utf-8" -> "text/turtle".
[[nodiscard]] std::string_view without_parameters(std::string_view media_type);

/// The quality 0..1000 that `accept` gives to a type, by its most specific matching range; none
/// when no range matches.  Elements that are not media ranges are skipped; parameters other than q
/// are ignored.
[[nodiscard]] std::optional<int> quality_of(std::string_view media_type, std::string_view accept);

/// As quality_of, but only a range that names the full type counts, never "*/*".
[[nodiscard]] std::optional<int> explicit_quality_of(std::string_view media_type,
                                                     std::string_view accept);

/// Index of the best offer; ties keep the server's order.  An Accept without any media range takes
/// the first.  None: no offer is acceptable.
[[nodiscard]] std::optional<std::size_t> negotiate(std::span<const std::string_view> offers,
                                                   std::string_view accept);

}  // namespace chorus::http

#include "common/http/conditional.h"

#include <algorithm>

#include "common/base/parse.h"
#include "common/http/text.h"

namespace chorus::http {

bool none_match_lists(std::string_view if_none_match, std::string_view etag) {
  if (trimmed(if_none_match) == "*") return true;
  while (!if_none_match.empty()) {
    std::string_view candidate = next_element(if_none_match, ',');
    if (candidate.starts_with("W/")) candidate.remove_prefix(2);
    if (!candidate.empty() && candidate == etag) return true;
  }
  return false;
}

std::optional<std::chrono::seconds> wait_preference(std::string_view prefer) {
  constexpr std::uint64_t kLongest = 86400;  // A day; the servers' own limits are far lower.
  while (!prefer.empty()) {
    std::string_view preference = next_element(prefer, ',');
    std::string_view token = next_element(preference, ';');
    const std::string_view name = next_element(token, '=');
    if (!equal_ignoring_case(name, "wait")) continue;
    const auto wait = parse_number<std::uint64_t>(trimmed(token));
    if (!wait) return std::nullopt;
    return std::chrono::seconds(std::min(*wait, kLongest));
  }
  return std::nullopt;
}

}  // namespace chorus::http

#include "common/http/media_range.h"

#include <algorithm>

#include "common/http/text.h"

namespace chorus::http {
namespace {

constexpr int kFullQuality = 1000;  // q=1.000 in thousandths

/// Reads "0", "0.5", "1.000" as thousandths (RFC 9110 12.4.2); none for anything else.
std::optional<int> parse_quality(std::string_view text) {
  constexpr std::size_t kLongest = 5;
  if (text.empty() || text.size() > kLongest || (text[0] != '0' && text[0] != '1')) return {};
  if (text.size() > 1 && text[1] != '.') return {};
  int thousandths = 0;
  for (std::size_t i = 0; i < kLongest; ++i) {
    if (i == 1) continue;
    const char digit = i < text.size() ? text[i] : '0';
    if (digit < '0' || digit > '9') return {};
    thousandths = thousandths * 10 + (digit - '0');
  }
  if (thousandths > kFullQuality) return {};
  return thousandths;
}

struct MediaRange {
  std::string_view type;
  std::string_view subtype;
  int quality = kFullQuality;
};

std::optional<MediaRange> parse_range(std::string_view element) {
  std::string_view rest = element;
  const std::string_view name = next_element(rest, ';');
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos || slash == 0 || slash + 1 == name.size()) return {};
  MediaRange range{name.substr(0, slash), name.substr(slash + 1)};
  if (range.type == "*" && range.subtype != "*") return {};
  while (!rest.empty()) {
    const std::string_view parameter = next_element(rest, ';');
    if (parameter.size() < 2 || ascii_lower(parameter[0]) != 'q' || parameter[1] != '=') continue;
    const auto quality = parse_quality(parameter.substr(2));
    if (!quality) return {};
    range.quality = *quality;
  }
  return range;
}

/// 0: no match, 1: */*, 2: type/*, 3: type/subtype.
int specificity(const MediaRange& range, std::string_view media_type) {
  if (range.type == "*") return 1;
  const std::size_t slash = media_type.find('/');
  if (slash == std::string_view::npos) return 0;
  if (!equal_ignoring_case(range.type, media_type.substr(0, slash))) return 0;
  if (range.subtype == "*") return 2;
  return equal_ignoring_case(range.subtype, media_type.substr(slash + 1)) ? 3 : 0;
}

std::optional<int> best_match(std::string_view media_type, std::string_view accept, int least) {
  const std::string_view bare = without_parameters(media_type);
  std::optional<int> quality;
  int most_specific = least - 1;
  while (!accept.empty()) {
    const auto range = parse_range(next_element(accept, ','));
    if (!range) continue;
    const int match = specificity(*range, bare);
    if (match == 0 || match < most_specific || match < least) continue;
    quality =
        match == most_specific && quality ? std::max(*quality, range->quality) : range->quality;
    most_specific = match;
  }
  return quality;
}

bool names_any_range(std::string_view accept) {
  while (!accept.empty()) {
    if (parse_range(next_element(accept, ','))) return true;
  }
  return false;
}

}  // namespace

std::string_view without_parameters(std::string_view media_type) {
  return trimmed(media_type.substr(0, media_type.find(';')));
}

std::optional<int> quality_of(std::string_view media_type, std::string_view accept) {
  return best_match(media_type, accept, 1);
}

std::optional<int> explicit_quality_of(std::string_view media_type, std::string_view accept) {
  return best_match(media_type, accept, 3);
}

std::optional<std::size_t> negotiate(std::span<const std::string_view> offers,
                                     std::string_view accept) {
  if (offers.empty()) return std::nullopt;
  if (!names_any_range(accept)) return 0;
  std::optional<std::size_t> best;
  int best_quality = 0;
  for (std::size_t i = 0; i < offers.size(); ++i) {
    const int quality = quality_of(offers[i], accept).value_or(0);
    if (quality > best_quality) {
      best_quality = quality;
      best = i;
    }
  }
  return best;
}

}  // namespace chorus::http

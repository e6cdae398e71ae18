#include "fusion-server/site/site_id.h"

#include <algorithm>

#include "common/base/fnv.h"

namespace chorus::site {
namespace {

constexpr std::size_t kMostCharacters = 64;
constexpr std::size_t kTimeDigits = 9;    // milliseconds until the year 5188
constexpr std::size_t kOriginDigits = 6;  // 2e9 origins

/// `value` in base 36, its last `digits` digits.
std::string in_base_36(std::uint64_t value, std::size_t digits) {
  constexpr std::string_view kDigits = "0123456789abcdefghijklmnopqrstuvwxyz";
  std::string text(digits, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, value /= 36)
    *digit = kDigits[value % 36];
  return text;
}

std::size_t digits_of(std::uint64_t value) {
  std::size_t digits = 1;
  while (value >= 36) {
    value /= 36;
    ++digits;
  }
  return digits;
}

bool allowed(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

}  // namespace

Result<SiteId> SiteId::parse(std::string_view text) {
  if (text.empty() || text.size() > kMostCharacters || !std::ranges::all_of(text, allowed))
    return fail(ErrorCode::InvalidArgument, "site id", "1-64 characters of [A-Za-z0-9_-]");
  return SiteId(std::string(text));
}

SiteIdSource::SiteIdSource(const CellId& cell, std::uint64_t boot)
    : origin_(in_base_36(fnv1a(std::to_string(boot), fnv1a(cell.str() + '/')), kOriginDigits)) {}

SiteId SiteIdSource::next(Timestamp now) {
  const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(
      std::max(Duration{0}, now.time_since_epoch()));
  const auto ms = static_cast<std::uint64_t>(since_epoch.count());
  ++count_;
  return *SiteId::parse(in_base_36(ms, kTimeDigits) + '-' + origin_ + '-' +
                        in_base_36(count_, digits_of(count_)));
}

}  // namespace chorus::site

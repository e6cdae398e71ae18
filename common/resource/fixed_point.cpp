#include "common/resource/fixed_point.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "common/base/parse.h"

namespace chorus::resource {
namespace {

constexpr double kMaxWritable = 1e15;  // Larger doubles have no decimals.
constexpr std::array<std::int64_t, 9> kPowersOfTen{
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};

}  // namespace

char* write_fixed(char* at, double value, int decimals) noexcept {
  const std::int64_t scale = kPowersOfTen[static_cast<std::size_t>(decimals)];
  std::int64_t scaled = std::llrint(value * static_cast<double>(scale));
  if (scaled < 0) {
    *at++ = '-';
    scaled = -scaled;
  }
  std::int64_t fraction = scaled % scale;
  at = std::to_chars(at, at + kMaxFixedLength, scaled / scale).ptr;
  *at++ = '.';
  for (int i = decimals - 1; i >= 0; --i) {
    at[i] = static_cast<char>('0' + fraction % 10);
    fraction /= 10;
  }
  return at + decimals;
}

std::optional<std::string> fixed(double value, int decimals) {
  if (!std::isfinite(value) || std::abs(value) > kMaxWritable) return std::nullopt;
  std::array<char, 64> text{};
  if (std::abs(value) <= kMaxFixed && decimals >= 1 && decimals <= 8) {
    return std::string(text.data(), write_fixed(text.data(), value, decimals));
  }
  const int size = std::snprintf(text.data(), text.size(), "%.*f", std::max(1, decimals), value);
  return std::string(text.data(), static_cast<std::size_t>(size));
}

std::optional<double> read_decimal(std::string_view text) noexcept {
  const auto value = parse_signed<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace chorus::resource

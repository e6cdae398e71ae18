#include "common/resource/fixed_point.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "common/base/parse.h"

namespace chorus::resource {
namespace {

constexpr double kMaxWritable = 1e15;  // Beyond it a double no longer holds one exact decimal.
constexpr std::size_t kMostDecimals = 8;
constexpr std::array<std::int64_t, kMostDecimals + 1> kPowersOfTen{
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};

/// "00", "01", ... "99".
constexpr auto kPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

void write_pair(char* at, std::uint32_t below_100) {
  std::memcpy(at, kPairs.data() + std::size_t{2} * below_100, 2);
}

}  // namespace

char* write_fixed(char* at, double value, int decimals) noexcept {
  const auto places = static_cast<std::size_t>(decimals);
  std::int64_t scaled = std::llrint(value * static_cast<double>(kPowersOfTen[places]));
  if (scaled < 0) {
    *at++ = '-';
    scaled = -scaled;
  }
  // Writes all eight decimals, so that every divisor is a constant.  The caller's next bytes
  // overwrite the decimals that are not wanted.
  const auto units = static_cast<std::uint64_t>(scaled * kPowersOfTen[kMostDecimals - places]);
  const std::uint64_t whole = units / 100'000'000U;
  const auto fraction = static_cast<std::uint32_t>(units % 100'000'000U);
  if (whole < 10) {
    *at++ = static_cast<char>('0' + whole);
  } else {
    at = std::to_chars(at, at + kMaxFixedLength, whole).ptr;
  }
  *at++ = '.';
  const std::uint32_t high = fraction / 10'000U;
  const std::uint32_t low = fraction % 10'000U;
  write_pair(at, high / 100U);
  write_pair(at + 2, high % 100U);
  write_pair(at + 4, low / 100U);
  write_pair(at + 6, low % 100U);
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

// Writes numbers with a fixed number of decimals: exact in xsd:decimal and JSON, and ten times
// faster than printf.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace chorus::resource {

/// Beyond this, a reader that keeps numbers as doubles, such as JavaScript, rounds integers.
inline constexpr std::int64_t kExactInteger = std::int64_t{1} << 53;

/// Larger numbers are not plausible coordinates, and the fast formatter does not handle them.
inline constexpr double kMaxFixed = 1e6;

/// Length of write_fixed's longest output: sign, 7 digits, point, 8 decimals.
inline constexpr int kMaxFixedLength = 17;

inline constexpr int kMostDecimals = 8;
inline constexpr std::array<std::int64_t, kMostDecimals + 1> kPowersOfTen{
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};

/// "00", "01", ... "99".
inline constexpr auto kDigitPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

/// Writes the four digits of a number below 10 000.
inline void write_four(char* at, std::uint32_t digits) noexcept {
  std::memcpy(at, kDigitPairs.data() + std::size_t{2} * (digits / 100U), 2);
  std::memcpy(at + 2, kDigitPairs.data() + std::size_t{2} * (digits % 100U), 2);
}

/// Writes `value`, rounded to 1..8 decimals, and returns the end.  |value| must be at most
/// kMaxFixed, and `at` must have room for kMaxFixedLength bytes: those after the end are undefined.
template <int kDecimals>
char* write_fixed(char* at, double value) noexcept {
  static_assert(kDecimals >= 1 && kDecimals <= kMostDecimals);
  constexpr std::int64_t kUnit = kPowersOfTen[kDecimals];
  const std::int64_t scaled = std::llrint(value * static_cast<double>(kUnit));
  *at = '-';  // Without a branch: half of all coordinates are negative, in no order.
  at += scaled < 0 ? 1 : 0;
  const auto units = static_cast<std::uint64_t>(scaled < 0 ? -scaled : scaled);
  const std::uint64_t whole = units / kUnit;
  const auto fraction = static_cast<std::uint32_t>(units % kUnit);
  if (whole < 10) {
    *at++ = static_cast<char>('0' + whole);
  } else {
    at = std::to_chars(at, at + kMaxFixedLength, whole).ptr;
  }
  *at++ = '.';
  // Writes four or eight decimals; the caller's next bytes overwrite those that are not wanted.
  if constexpr (kDecimals <= 4) {
    write_four(at, fraction * static_cast<std::uint32_t>(kPowersOfTen[4 - kDecimals]));
  } else {
    const auto eight = fraction * static_cast<std::uint32_t>(kPowersOfTen[8 - kDecimals]);
    write_four(at, eight / 10'000U);
    write_four(at + 4, eight % 10'000U);
  }
  return at + kDecimals;
}

/// The same for a number of decimals that is not known when compiling.
char* write_fixed(char* at, double value, int decimals) noexcept;

/// Writes any number with fixed decimals; nullopt when it is not finite or is beyond 1e15.
[[nodiscard]] std::optional<std::string> fixed(double value, int decimals);

}  // namespace chorus::resource

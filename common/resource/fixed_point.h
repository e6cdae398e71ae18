// Writes numbers with a fixed number of decimals: exact in xsd:decimal and JSON, and ten times
// faster than printf.
#pragma once

#include <array>
#include <bit>
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

/// Eight bytes as a number whose lowest byte is the first.
inline std::uint64_t eight_bytes(const char* at) noexcept {
  std::uint64_t bytes = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&bytes, at, sizeof bytes);
  } else {
    for (unsigned i = 0; i < 8; ++i)
      bytes |= std::uint64_t{static_cast<unsigned char>(at[i])} << (8U * i);
  }
  return bytes;
}

/// True if each byte is a number from 0 to 9.
inline bool are_digits(std::uint64_t bytes) noexcept {
  return (((bytes + 0x7676767676767676U) | bytes) & 0x8080808080808080U) == 0;
}

/// The number that eight digits make, one in each byte and the first in the lowest.
inline std::uint32_t number_of(std::uint64_t digits) noexcept {
  constexpr std::uint64_t kEveryFourth = 0x000000FF000000FFU;
  const std::uint64_t pairs = digits * 10 + (digits >> 8U);  // in every other byte
  const std::uint64_t upper = (pairs & kEveryFourth) * (100U + (std::uint64_t{1'000'000} << 32U));
  const std::uint64_t lower =
      ((pairs >> 16U) & kEveryFourth) * (1U + (std::uint64_t{10'000} << 32U));
  return static_cast<std::uint32_t>((upper + lower) >> 32U);
}

/// Reads a decimal with one digit before the point and exactly `kDecimals` behind it, such as
/// "-1.2345", as the nearest double, and returns its end.  Null if the text begins otherwise, or
/// within 12 bytes of `end`.
template <int kDecimals>
const char* read_short_fixed(const char* at, const char* end, double& out) noexcept {
  static_assert(kDecimals >= 1 && kDecimals <= kMostDecimals);
  constexpr std::ptrdiff_t kRoom = 12;  // sign, digit, point, eight decimals, what follows
  if (end - at < kRoom) return nullptr;
  const bool negative = *at == '-';
  at += negative ? 1 : 0;
  const auto digit = [&](std::ptrdiff_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(at[i])) - '0';
  };
  // Zeros take the place of the digits before the first.
  const std::uint64_t digits = (eight_bytes(at + 2) ^ 0x3030303030303030U)
                               << (8U * (kMostDecimals - kDecimals));
  const std::uint32_t whole = digit(0);
  if (whole > 9 || at[1] != '.' || digit(2 + kDecimals) <= 9 || !are_digits(digits)) return nullptr;
  constexpr std::int64_t kUnit = kPowersOfTen[kDecimals];
  const auto units = static_cast<std::int64_t>(whole) * kUnit + number_of(digits);
  const double value = static_cast<double>(units) / static_cast<double>(kUnit);
  out = negative ? -value : value;
  return at + 2 + kDecimals;
}

/// Writes any number with fixed decimals; nullopt when it is not finite or is beyond 1e15.
[[nodiscard]] std::optional<std::string> fixed(double value, int decimals);

/// The finite number that the whole string spells: "-1.25", "1.5e-3".
[[nodiscard]] std::optional<double> read_decimal(std::string_view text) noexcept;

}  // namespace chorus::resource

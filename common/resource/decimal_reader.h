// Reads numbers: any decimal, and fast those that fixed_point.h has written.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "common/resource/fixed_point.h"

namespace chorus::resource {

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

/// The finite number that the whole string spells: "-1.25", "1.5e-3".
[[nodiscard]] std::optional<double> read_decimal(std::string_view text) noexcept;

}  // namespace chorus::resource

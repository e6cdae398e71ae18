// NatNet's byte order and strings: little-endian; a string ends with NUL or is padded with it.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace chorus::natnet {

using Bytes = std::vector<char>;

template <std::unsigned_integral Unsigned>
void append(Bytes& out, Unsigned value) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    out.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
  }
}
inline void append(Bytes& out, std::int16_t value) {
  append(out, static_cast<std::uint16_t>(value));
}
inline void append(Bytes& out, std::int32_t value) {
  append(out, static_cast<std::uint32_t>(value));
}
inline void append(Bytes& out, float value) { append(out, std::bit_cast<std::uint32_t>(value)); }
inline void append(Bytes& out, double value) { append(out, std::bit_cast<std::uint64_t>(value)); }

/// Appends a string and its NUL.
inline void append_text(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
  out.push_back('\0');
}

/// The number whose bytes begin at `at`; all of them must be there.
template <std::unsigned_integral Unsigned>
requires(sizeof(Unsigned) > 1) [[nodiscard]] Unsigned
    number_at(std::span<const char> bytes, std::size_t at) {
  Unsigned value = 0;
  for (std::size_t i = sizeof(Unsigned); i > 0; --i) {
    value = static_cast<Unsigned>((value << 8) | static_cast<unsigned char>(bytes[at + i - 1]));
  }
  return value;
}

}  // namespace chorus::natnet

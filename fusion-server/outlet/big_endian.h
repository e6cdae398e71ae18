// Network byte order, as in OSC, VRPN and MXTP: the most significant byte first.
#pragma once

#include <array>
#include <concepts>

namespace chorus::outlet {

template <std::unsigned_integral Unsigned>
[[nodiscard]] std::array<char, sizeof(Unsigned)> big_endian(Unsigned value) {
  std::array<char, sizeof(Unsigned)> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>((value >> (8 * (bytes.size() - 1 - i))) & 0xFFU);
  }
  return bytes;
}

/// Appends to a std::string or a std::vector<char>.
template <class Bytes, std::unsigned_integral Unsigned>
void append_big_endian(Bytes& out, Unsigned value) {
  const auto bytes = big_endian(value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace chorus::outlet

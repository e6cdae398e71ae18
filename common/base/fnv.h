// FNV-1a, 64 bit: the same number for the same bytes in every run and on every machine.
#pragma once

#include <cstdint>
#include <string_view>

namespace chorus {

/// The hash of no bytes; hashing starts with it.
inline constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325;

/// The hash of `bytes`; to continue, pass the hash of the bytes before them.
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view bytes,
                                            std::uint64_t hash = kFnvBasis) noexcept {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * kPrime;
  return hash;
}

}  // namespace chorus

#include "common/resource/fixed_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace chorus::resource {
namespace {

constexpr double kMaxWritable = 1e15;  // Beyond it a double no longer holds one exact decimal.

using WriteFixed = char* (*)(char*, double) noexcept;
constexpr std::array<WriteFixed, kMostDecimals> kByDecimals{
    write_fixed<1>, write_fixed<2>, write_fixed<3>, write_fixed<4>,
    write_fixed<5>, write_fixed<6>, write_fixed<7>, write_fixed<8>};

}  // namespace

char* write_fixed(char* at, double value, int decimals) noexcept {
  return kByDecimals[static_cast<std::size_t>(decimals - 1)](at, value);
}

std::optional<std::string> fixed(double value, int decimals) {
  if (!std::isfinite(value) || std::abs(value) > kMaxWritable) return std::nullopt;
  std::array<char, 64> text{};
  if (std::abs(value) <= kMaxFixed && decimals >= 1 && decimals <= kMostDecimals) {
    return std::string(text.data(), write_fixed(text.data(), value, decimals));
  }
  const int size = std::snprintf(text.data(), text.size(), "%.*f", std::max(1, decimals), value);
  return std::string(text.data(), static_cast<std::size_t>(size));
}

}  // namespace chorus::resource

// Reads big-endian numbers from bytes that may end anywhere.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace chorus::suit {

/// After the first read beyond the end, everything read is zero and ok() is false.
class BigEndianReader {
 public:
  explicit BigEndianReader(std::span<const char> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

  std::uint32_t number(std::size_t width) {
    std::uint32_t value = 0;
    for (const char byte : text(width)) value = (value << 8) | static_cast<unsigned char>(byte);
    return value;
  }
  double real() { return static_cast<double>(std::bit_cast<float>(number(4))); }
  std::string_view text(std::size_t size) {
    if (size > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return {};
    }
    const std::string_view out(bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return out;
  }

 private:
  std::span<const char> bytes_;
  bool ok_ = true;
};

}  // namespace chorus::suit

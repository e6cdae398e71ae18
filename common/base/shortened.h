// Cuts long text from outside the program before it is logged, shown or quoted in an error.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace chorus {

/// How much is kept of a reason that may quote what a stranger sent [bytes].
inline constexpr std::size_t kMaxReason = 500;

/// The text; if it has more than `most` bytes, its beginning, which ends between characters of
/// UTF-8, and "...".
[[nodiscard]] inline std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  constexpr unsigned char kMask = 0xC0;
  constexpr unsigned char kContinued = 0x80;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & kMask) == kContinued) --end;
  return std::string(text.substr(0, end)) + "...";
}

}  // namespace chorus

#include "common/exporters/number_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace chorus::exporters {
namespace {

constexpr std::size_t kLongest = 512;  // Room for the largest double in fixed notation.

}  // namespace

void append_fixed(std::string& text, double value, int digits) {
  std::array<char, kLongest> buffer{};
  const double finite = std::isfinite(value) ? value : 0.0;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), finite,
                                 std::chars_format::fixed, digits)
                       .ptr;
  std::string_view shown(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  if (shown.starts_with('-') && shown.find_first_not_of("-0.") == std::string_view::npos)
    shown.remove_prefix(1);
  text += shown;
}

void append_exact(std::string& text, double value) {
  std::array<char, kLongest> buffer{};
  const double finite = std::isfinite(value) ? value : 0.0;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), finite, std::chars_format::fixed)
          .ptr;
  text.append(buffer.data(), end);
}

}  // namespace chorus::exporters

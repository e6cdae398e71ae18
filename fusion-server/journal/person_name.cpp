#include "fusion-server/journal/person_name.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace chorus::journal {
namespace {

struct Range {
  char32_t first;
  char32_t last;
};

/// Controls, invisible characters, and those that change the direction or break the line.
constexpr std::array kRefused{Range{0x00, 0x1F},     Range{0x7F, 0x9F},     Range{0xAD, 0xAD},
                              Range{0x61C, 0x61C},   Range{0x200B, 0x200F}, Range{0x2028, 0x202E},
                              Range{0x2060, 0x206F}, Range{0xFEFF, 0xFEFF}, Range{0xFFF0, 0xFFFF}};

/// Takes one character from the front of `text`; none if it is not UTF-8 (RFC 3629).
std::optional<char32_t> take_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  const std::size_t size = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if ((lead >= 0x80 && lead < 0xC2) || lead > 0xF4 || text.size() < size) return std::nullopt;
  constexpr std::array<char32_t, 5> kLeadBits{0, 0x7F, 0x1F, 0x0F, 0x07};
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  char32_t value = lead & kLeadBits[size];
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return std::nullopt;
    value = (value << 6) | (byte(i) & 0x3F);
  }
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < kLeast[size] || surrogate || value > 0x10FFFF) return std::nullopt;
  text.remove_prefix(size);
  return value;
}

tl::unexpected<Error> refused(const char* why) {
  return fail(ErrorCode::InvalidArgument, "name", why);
}

}  // namespace

Result<std::string> checked_name(std::string_view text) {
  const auto begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return std::string();
  const std::string_view name = text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
  std::size_t count = 0;
  for (std::string_view rest = name; !rest.empty(); ++count) {
    const auto one = take_character(rest);
    if (!one) return refused("the name is not UTF-8");
    if (*one == '/' || *one == '\\') return refused("a name has no slash and no backslash");
    if (std::ranges::any_of(kRefused, [&](Range r) { return *one >= r.first && *one <= r.last; }))
      return refused("a name has no control characters and none that are not seen");
  }
  if (count > kLongestName)
    return refused("a name has at most 40 characters; choose a shorter one");
  return std::string(name);
}

}  // namespace chorus::journal

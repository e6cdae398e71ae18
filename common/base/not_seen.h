// How other programs write a point that was not seen: the one rule for importers and the bridge.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

namespace chorus {

/// True for a text that stands for a missing number: nothing, or a word of numpy, pandas, R,
/// MATLAB, Excel, Python's json or the C runtimes, in any case ("NaN", "-nan(ind)", "None", "#N/A",
/// "-").
[[nodiscard]] inline bool is_not_seen(std::string_view text) {
  constexpr std::array<std::string_view, 16> kWords{
      "",     "nan",  "-nan",    "+nan", "na",  "n/a",  "#n/a",  "#n/a n/a",
      "null", "none", "missing", "<na>", "inf", "-inf", "#num!", "-"};
  std::string word(text.substr(0, 16));
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  // The C runtimes add what kind it is: "-nan(ind)", "nan(snan)", "-1.#IND", "1.#QNAN".
  if (word.starts_with("nan(") || word.starts_with("-nan(")) return true;
  if (word.find(".#") != std::string::npos) return true;
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// True for a place (any vector of numbers) that is not finite, or exactly 0 in all coordinates,
/// where no joint ever is: many programs write that for a point that they lost.
template <class Vector>
[[nodiscard]] bool is_nowhere(const Vector& place) {
  bool zero = true;
  for (const auto& x : place) {
    if (!std::isfinite(x)) return true;
    zero = zero && x == 0;
  }
  return zero;
}

/// A JSON text with null for NaN, Infinity, None and the like outside of quotes, which JSON does
/// not have, but which Python and C write for what was not seen.
[[nodiscard]] inline std::string null_for_nan(std::string_view text) {
  constexpr std::array<std::string_view, 12> kWords{
      "-nan(ind)", "nan(ind)", "-Infinity", "Infinity", "-NaN", "NaN",
      "-nan",      "nan",      "-inf",      "inf",      "None", "NULL"};
  std::string out;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size();) {
    const auto word = std::find_if(kWords.begin(), kWords.end(), [&](std::string_view each) {
      return !quoted && text.substr(i).starts_with(each);
    });
    if (word != kWords.end()) {
      out += "null";
      i += word->size();
      continue;
    }
    if (text[i] == '"') quoted = !quoted;
    if (quoted && text[i] == '\\' && i + 1 < text.size()) out += text[i++];
    out += text[i++];
  }
  return out;
}

}  // namespace chorus

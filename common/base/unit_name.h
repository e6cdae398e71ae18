// Units of length by name: of the option --unit, and as motion files state them.
#pragma once

#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/parse.h"

namespace chorus {

/// Metres in the unit of this name, in any case ("mm", "CM", "Meters", "inch"); none if unknown.
[[nodiscard]] inline std::optional<double> metres_in(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 26> kUnits{{
      {"mm", 0.001},          {"millimeter", 0.001}, {"millimetre", 0.001}, {"millimeters", 0.001},
      {"millimetres", 0.001}, {"cm", 0.01},          {"centimeter", 0.01},  {"centimetre", 0.01},
      {"centimeters", 0.01},  {"centimetres", 0.01}, {"dm", 0.1},           {"m", 1.0},
      {"meter", 1.0},         {"metre", 1.0},        {"meters", 1.0},       {"metres", 1.0},
      {"in", 0.0254},         {"inch", 0.0254},      {"inches", 0.0254},    {"ft", 0.3048},
      {"foot", 0.3048},       {"feet", 0.3048},      {"um", 1e-6},          {"micrometer", 1e-6},
      {"micrometers", 1e-6},  {"yd", 0.9144},
  }};
  std::string word(unit);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  while (!word.empty() && (word.back() == ' ' || word.back() == '\0' || word.back() == '.'))
    word.pop_back();
  for (const auto& [name, metres] : kUnits) {
    if (name == word) return metres;
  }
  return std::nullopt;
}

/// The same, or a number above 0: what --unit takes.
[[nodiscard]] inline std::optional<double> unit_or_factor(std::string_view text) {
  if (const auto named = metres_in(text)) return named;
  const auto factor = parse_finite(text);
  return factor && *factor > 0.0 ? factor : std::nullopt;
}

}  // namespace chorus

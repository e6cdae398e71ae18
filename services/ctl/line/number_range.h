// A check of numbers on the command line.
#pragma once

#include <cmath>
#include <string>

#include <CLI/CLI.hpp>

namespace chorus::ctl {

/// From `least` to `most`, both included.  Unlike CLI::Range it also refuses "nan".
inline CLI::Validator number_range(double least, double most) {
  const CLI::Range range(least, most);
  const auto check = [range, least, most](std::string& text) -> std::string {
    double value = 0.0;
    const bool number = CLI::detail::lexical_cast(text, value);
    if (number && value >= least && value <= most) return {};
    return number && !std::isnan(value) ? range(text)
                                        : text + " is not a number (units are not written)";
  };
  return {check, range.get_description()};
}

}  // namespace chorus::ctl

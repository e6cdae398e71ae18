// Writes numbers as every reader understands them: with a decimal point, independent of the locale,
// and without an exponent, "-0" or "nan".
#pragma once

#include <string>

namespace chorus::exporters {

/// Of a time [s]: microseconds.
inline constexpr int kTimeDigits = 6;

/// Appends a number with `digits` after the point; 0 if it is not finite.
void append_fixed(std::string& text, double value, int digits);

/// Appends the shortest string that reads back as the same number.
void append_exact(std::string& text, double value);

}  // namespace chorus::exporters

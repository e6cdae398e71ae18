// Writes numbers in a form that every program can read: with a decimal point, whatever the locale,
// and without an exponent or "nan".
#pragma once

#include <string>

namespace chorus::exporters {

/// Number of digits after the point of a time in seconds, which is written to the microsecond.
inline constexpr int kTimeDigits = 6;

/// Appends a number with `digits` after the point, never "-0"; 0 if it is not finite.
void append_fixed(std::string& text, double value, int digits);

/// Appends the shortest string that reads back as the same number; 0 if it is not finite.
void append_exact(std::string& text, double value);

}  // namespace chorus::exporters

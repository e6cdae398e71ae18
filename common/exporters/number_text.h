// Numbers that every reader understands: with a decimal point and without exponent, locale, "-0" or
// "nan".
#pragma once

#include <string>

namespace chorus::exporters {

/// Appends a number with `digits` after the point; 0 if it is not finite.
void append_fixed(std::string& text, double value, int digits);

/// Appends the shortest text that reads back as the same number.
void append_exact(std::string& text, double value);

}  // namespace chorus::exporters

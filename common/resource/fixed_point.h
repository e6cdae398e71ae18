// Numbers with a fixed count of decimals: exact in xsd:decimal and JSON, and ten times faster than
// printf.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace chorus::resource {

/// Beyond this a coordinate is absurd, and the fast formatter does not handle it.
inline constexpr double kMaxFixed = 1e6;

/// Longest output of write_fixed: sign, 7 digits, point, 8 decimals.
inline constexpr int kMaxFixedLength = 17;

/// Writes `value`, rounded to 1..8 `decimals`, and returns the end.  |value| must be at most
/// kMaxFixed.
char* write_fixed(char* at, double value, int decimals) noexcept;

/// Any number as fixed decimals; nullopt when it is not finite or beyond 1e15.
[[nodiscard]] std::optional<std::string> fixed(double value, int decimals);

/// Reads "-1.25", "1.5e-3"; the whole text, finite.
[[nodiscard]] std::optional<double> read_decimal(std::string_view text) noexcept;

}  // namespace chorus::resource

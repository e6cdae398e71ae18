// Writes numbers with a fixed number of decimals: exact in xsd:decimal and JSON, and ten times
// faster than printf.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace chorus::resource {

/// Beyond this, a reader that keeps numbers as doubles, such as JavaScript, rounds integers.
inline constexpr std::int64_t kExactInteger = std::int64_t{1} << 53;

/// Larger numbers are not plausible coordinates, and the fast formatter does not handle them.
inline constexpr double kMaxFixed = 1e6;

/// Length of write_fixed's longest output: sign, 7 digits, point, 8 decimals.
inline constexpr int kMaxFixedLength = 17;

/// Writes `value`, rounded to 1..8 `decimals`, and returns the end.  |value| must be at most
/// kMaxFixed, and `at` must have room for kMaxFixedLength bytes: those after the end are undefined.
char* write_fixed(char* at, double value, int decimals) noexcept;

/// Writes any number with fixed decimals; nullopt when it is not finite or is beyond 1e15.
[[nodiscard]] std::optional<std::string> fixed(double value, int decimals);

/// The finite number that the whole string spells: "-1.25", "1.5e-3".
[[nodiscard]] std::optional<double> read_decimal(std::string_view text) noexcept;

}  // namespace chorus::resource

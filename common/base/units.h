// Units: radians and metres everywhere inside; degrees and millimetres only where humans read or
// write them.
#pragma once

#include <numbers>

namespace chorus {

/// Degrees to radians: `deg(30)`.
[[nodiscard]] constexpr double deg(double degrees) noexcept {
  return degrees * std::numbers::pi / 180.0;
}

/// Radians to degrees, for reports and config.
[[nodiscard]] constexpr double to_deg(double radians) noexcept {
  return radians * 180.0 / std::numbers::pi;
}

/// Millimetres to metres: `mm(20)`.
[[nodiscard]] constexpr double mm(double millimetres) noexcept { return millimetres / 1000.0; }

/// Metres to millimetres, for reports.
[[nodiscard]] constexpr double to_mm(double metres) noexcept { return metres * 1000.0; }

}  // namespace chorus

// Tukey's biweight, and the scale of the residuals that it requires.
#pragma once

namespace chorus::registration {

/// Where the biweight becomes zero, in standard deviations; has 95 % efficiency for Gaussian
/// errors.
inline constexpr double kTukey = 4.685;

/// Median of the norm of a 3-D standard Gaussian.
inline constexpr double kMedianToSigma = 1.538;

/// Least scale, in sigmas; avoids a division by zero for perfect pairs.
inline constexpr double kMinScale = 0.02;

/// Weight in [0, 1] of a residual; `squared_ratio` is (residual / (kTukey * scale))^2.
[[nodiscard]] constexpr double tukey_weight(double squared_ratio) noexcept {
  return squared_ratio < 1.0 ? (1.0 - squared_ratio) * (1.0 - squared_ratio) : 0.0;
}

}  // namespace chorus::registration

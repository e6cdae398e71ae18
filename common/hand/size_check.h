// Whether a hand's size is right.  One camera cannot tell: a hand 3 % too large is 3 % too far
// away. It can be told where something else says how far the wrist is, such as a placed suit.
#pragma once

#include <span>

namespace chorus::hand {

struct SizeCheck {
  /// The true size relative to the skeleton's; 1 when nothing is known.
  double factor = 1.0;
  double sigma = 1.0;  ///< Standard deviation of the factor.
  /// Wrong by more than 2 %, and by more than three standard deviations.
  [[nodiscard]] bool wrong() const;
};

/// Distances of the wrist from the camera [m] at the same instants, `rate_hz` of them a second: by
/// the hand's picture, and by something else.  What errs alike for a second counts once.  Values
/// that are not positive and finite are left out.
[[nodiscard]] SizeCheck check_size(std::span<const double> by_hand,
                                   std::span<const double> by_other, double rate_hz);

}  // namespace chorus::hand

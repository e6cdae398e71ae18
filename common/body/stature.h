// A person's stature from the lengths of their bones.
#pragma once

#include <array>
#include <optional>

#include "common/body/skeleton.h"

namespace chorus {

/// A length that was learned, and its standard deviation [m]; `sigma` 0: not known.
struct LearnedLength {
  double length = 0.0;
  double sigma = 0.0;
};

/// Of the bone that ends in each joint (bones.h); SpineBase ends none.
using BoneLengthOf = std::array<LearnedLength, kJointCount>;

/// Ankle to knee to hip to shoulder, as a share of the stature (Drillis and Contini 1966).
inline constexpr double kChainOfStature = 0.779;
/// Standard deviation of that, relative, for hips and shoulders where sensors put them (decision
/// 0082).
inline constexpr double kStatureScale = 0.04;

/// Shank, thigh and spine up to the shoulders over kChainOfStature; its sigma includes
/// kStatureScale.  None while one of these is not known of either side.
[[nodiscard]] std::optional<LearnedLength> stature_of(const BoneLengthOf& bones);

}  // namespace chorus

// Codes that RULA and REBA share: both take the upper arm from the same drawing.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/ergonomics/limits.h"
#include "common/ergonomics/seen.h"

namespace chorus::ergonomics {

/// 1 to 6 before support of the arm is taken off; 0: unknown.
[[nodiscard]] inline std::int8_t upper_arm_code(const Seen& seen, Side side) {
  const double raise = seen.measures.at(Limb::UpperArmRaise, side);
  if (std::isnan(raise)) return 0;
  const Limits& limit = limits();
  int code = 1;
  if (raise < -limit.rula_upper_arm_low || raise > limit.rula_upper_arm_low) code = 2;
  if (raise > limit.rula_upper_arm_middle) code = 3;
  if (raise > limit.rula_upper_arm_high) code = 4;
  code += seen.measures.at(Limb::UpperArmAbduction, side) > limit.abducted ? 1 : 0;
  code += seen.measures.at(Limb::ShoulderRaise, side) > limit.shoulder_raised ? 1 : 0;
  return static_cast<std::int8_t>(code);
}

/// 1: bent by 60 to 100 degrees, 2: otherwise; 0: unknown.
[[nodiscard]] inline std::int8_t lower_arm_code(const Seen& seen, Side side) {
  const double elbow = seen.measures.at(Limb::ElbowFlexion, side);
  if (std::isnan(elbow)) return 0;
  return elbow < limits().rula_lower_arm_least || elbow > limits().rula_lower_arm_most ? 2 : 1;
}

/// 1 where the trunk or neck is twisted or bent sideways, else 0.
[[nodiscard]] inline int asymmetry(double twist, double side) {
  return std::abs(twist) > limits().twisted || std::abs(side) > limits().side_bent ? 1 : 0;
}

}  // namespace chorus::ergonomics

// The limits between the classes of the methods, read from tables/limits.txt, which names their
// sources.  Radians and metres.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::ergonomics {

struct Limits {
  double rula_upper_arm_low, rula_upper_arm_middle, rula_upper_arm_high;
  double rula_lower_arm_least, rula_lower_arm_most;
  double rula_neck_low, rula_neck_high;
  double rula_trunk_low, rula_trunk_high;
  double rula_wrist;
  double reba_trunk_low, reba_trunk_high, reba_neck, reba_knee_low, reba_knee_high, reba_wrist;
  double owas_bent, owas_twisted, owas_knee, owas_arm_at_least;
  double iso_trunk_low, iso_trunk_high, iso_asymmetric, iso_head_low, iso_head_high, iso_neck;
  double iso_upper_arm_low, iso_upper_arm_high;
  double en_trunk_low, en_trunk_high, en_asymmetric, en_upper_arm_low, en_upper_arm_high, en_head;
  double eaws_bent, eaws_strongly_bent, eaws_elbow_at_least;
  double upright, twisted, side_bent, abducted, shoulder_raised;
  double across, out;
  double foot_lifted, knee_on_floor, shank_lying, thigh_level, shank_upright, seated_knee, lying;
};

struct LimitRow {
  std::string name;
  double value = 0.0;  ///< [rad] or [m]
  std::string unit;    ///< As printed: "deg" or "m".
  std::string source;
};

/// Reads "name value unit source"; Malformed for an unknown unit, an unknown or a missing name.
[[nodiscard]] Result<std::vector<LimitRow>> read_limits(std::string_view text,
                                                        std::string_view file);

[[nodiscard]] const Limits& limits();
[[nodiscard]] const std::vector<LimitRow>& limit_rows();

}  // namespace chorus::ergonomics

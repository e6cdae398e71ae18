// The table of scenes in which fusion is measured.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/methods/contest.h"

namespace chorus::bench {

inline constexpr const char* kMainCase = "workshop6-A";

/// All draws of one case.
struct FusionCase {
  std::string name;
  Contest contest;
  bool in_full = false;  ///< Reports every metric, not only the first ones.
  bool quick = false;    ///< Part of the smoke run.
  bool cold = false;     ///< Draws rotate through the ways to begin, see begin_cold().
  std::size_t draws = 20;
};

/// A ring of `sensors` sensors around one person who moves along `walk`.
[[nodiscard]] Contest contest_of(const std::string& profile, std::size_t sensors,
                                 synthetic::PathKind walk);

/// Walking, standing, turning, at work, cold starts, on every profile; few and many sensors.
[[nodiscard]] std::vector<FusionCase> main_cases();

/// Cases that vary the yaws at which left and right are swapped; everything else is as in profile
/// A.
[[nodiscard]] std::vector<FusionCase> flip_cases();

/// Makes the person begin in the way that the draw's number selects.
void begin_cold(Setting& setting, std::size_t draw);

}  // namespace chorus::bench

// The scenes that fusion is measured in, as a table.
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
  bool in_full = false;   ///< Every metric, not only the first ones.
  std::string also = {};  ///< The short rows under this name too.
  bool quick = false;     ///< Part of the smoke run.
  bool cold = false;      ///< Draws take turns in how they begin, see begin_cold().
  std::size_t draws = 20;
};

/// A ring of so many sensors around one person who moves like this.
[[nodiscard]] Contest contest_of(const std::string& profile, std::size_t sensors,
                                 synthetic::PathKind walk);

/// Walking, standing, turning, at work, met cold on every profile; few and many sensors.
[[nodiscard]] std::vector<FusionCase> main_cases();

/// One habit of exchanging left and right after the other, all else profile A.
[[nodiscard]] std::vector<FusionCase> flip_cases();

/// Somebody who begins as is the turn of this draw.
void begin_cold(Setting& setting, std::size_t draw);

}  // namespace chorus::bench

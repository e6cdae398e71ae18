// The cases of `chorus-bench site`: identities across cells and places of cells, simulated at the
// level of what cells publish; and those with real processes.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Eight cells, twelve people; beside `cascade` and `cells-alone`.
void run_hall_case(Report& report);
/// What must be true for a hand-over: two people, and what is wrong of places, clocks and sight.
void run_hand_over_case(Report& report);
/// Places and clocks of eight cells from one person who walks through all of them.
[[nodiscard]] Result<void> run_places_case(Report& report);

/// A case with real processes, by its name: `line-4x4`, `lost`, `faults`, `readers` or `streams`.
[[nodiscard]] Result<void> run_real_case(Report& report, const char* name);

}  // namespace chorus::bench

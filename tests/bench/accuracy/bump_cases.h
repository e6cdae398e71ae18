// The case "bump": how soon the fusion server detects that a sensor was moved, how that affects the
// output, and how often there is a false alarm.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

void measure_bumps(Report& report);

}  // namespace chorus::bench

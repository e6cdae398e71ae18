// The case "bump": how soon the fusion server notices that a sensor was moved, what that costs the
// output, and how often it is wrong.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

void measure_bumps(Report& report);

}  // namespace chorus::bench

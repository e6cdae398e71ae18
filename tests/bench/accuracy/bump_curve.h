// The case "bump-curve": which part of all pushes the watch tells of within five seconds, against
// how often it tells of one that was none, for several limits.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// One room with two people is watched undisturbed.  Again and again a copy of the watch as it is
/// then sees one sensor pushed: what the sensor shows is moved as if it stood elsewhere.  So each
/// simulated hour serves both sides of the curve.
void measure_bump_curve(Report& report);

}  // namespace chorus::bench

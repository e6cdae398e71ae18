// The case "bump-curve": for several limits, the fraction of the pushes that the watch reports
// within five seconds, and how often it raises a false alarm.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// One room with two people is watched undisturbed.  Again and again the watch is copied, and the
/// copy sees one sensor pushed: what the sensor shows is moved as if it stood elsewhere.  So each
/// simulated hour yields false alarms as well as reported pushes.
void measure_bump_curve(Report& report);

}  // namespace chorus::bench

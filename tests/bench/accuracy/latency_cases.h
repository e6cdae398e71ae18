// Sensors that differ in latency: what the walk tells of it, and what taking it off is worth.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Rings of six and pairs, whose sensors stamp 0, 20 and 50 ms late in turns, or all in time.
void measure_latencies(Report& report);

}  // namespace chorus::bench

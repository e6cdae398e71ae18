// Registration of very many sensors: how long it takes.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

inline constexpr const char* kScale = "scale-64";

/// Reports processor time and accuracy for 64 sensors around one walk of 30 s, solved as the server
/// does.
void measure_scale(Report& report);

}  // namespace chorus::bench

// How draws of fusion become rows: one row for each figure and each method beside ours.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/contest.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// For each draw, what hold() gives.
using Draws = std::vector<std::vector<Scored>>;

/// True for the few figures that every case reports.
[[nodiscard]] bool is_short_metric(const Metric& metric);

/// One figure of all methods, `metric` being its index in metrics().
[[nodiscard]] Comparison compare(const std::string& name, const Draws& draws, std::size_t metric);

/// Reports the figures of all methods, all of them or only the short ones; returns the comparison
/// of mpjpe_mm.
Comparison report_draws(Report& report, const std::string& name, const Draws& draws, bool in_full);

}  // namespace chorus::bench

// Means of blocks of a time series, and the confidence interval that they give.
#pragma once

#include <span>
#include <vector>

#include "common/comparison/comparison.h"

namespace chorus::comparison {

/// Values with their times [s], in order of time.
struct Series {
  std::vector<double> times;
  std::vector<double> values;
};

/// The mean of the series with an interval from the means of its blocks: Student's t with one
/// degree of freedom less than there are blocks.  Blocks are `block` seconds long, or a tenth of
/// the series if that is less.  With fewer than two blocks the half width is infinite.  Equal
/// values have the half width 0.
[[nodiscard]] Estimate mean_of(const Series& series, double block, double confidence);

/// The slope of the series in units per second, in the same way: from the least-squares slope over
/// the means of blocks.
[[nodiscard]] Estimate slope_of(const Series& series, double block, double confidence);

}  // namespace chorus::comparison

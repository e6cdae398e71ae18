// Medians and percentiles of benchmark runs.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace chorus::bench {

/// Percentile by linear interpolation, `share` in [0, 1]; NaN for no values.  NaN counts as
/// infinitely bad, because a failed run must not improve a result.
[[nodiscard]] inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  for (double& value : values) {
    if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
  }
  std::sort(values.begin(), values.end());
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  if (std::isinf(values[above]))
    return place > static_cast<double>(below) ? values[above] : values[below];
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

[[nodiscard]] inline double median(const std::vector<double>& values) {
  return percentile(values, 0.5);
}
[[nodiscard]] inline double worst(const std::vector<double>& values) {
  return percentile(values, 1.0);
}

}  // namespace chorus::bench

// The median.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace chorus {

/// For an even number of values, the upper of the two middle ones.  `values` must not be empty.
template <class Value>
[[nodiscard]] Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::move(*middle);
}

}  // namespace chorus

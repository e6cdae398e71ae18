// A bounded sample of a long series, for its quantiles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace chorus::quality {

/// NaN of nothing.
[[nodiscard]] inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto place = std::min(values.size() - 1,
                              static_cast<std::size_t>(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Beyond `most` values each new one takes the place of one that is drawn by a fixed sequence.  The
/// median of 20 000 lies within 0.9 % of the scatter of the true one.
class Sample {
 public:
  explicit Sample(std::size_t most = 20'000) : most_(most) {}

  void add(double value) {
    ++seen_;
    if (values_.size() < most_) return values_.push_back(value);
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    const std::size_t place = (state_ >> 16U) % seen_;
    if (place < values_.size()) values_[place] = value;
  }
  [[nodiscard]] double at(double share) const { return quantile(values_, share); }
  [[nodiscard]] std::size_t seen() const { return seen_; }

 private:
  std::size_t most_;
  std::vector<double> values_;
  std::size_t seen_ = 0;
  std::uint64_t state_ = 1;
};

}  // namespace chorus::quality

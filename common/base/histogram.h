// A histogram: counts how many measured values fell into each of several ranges.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace chorus {

/// Counts values by bucket.  Any thread may call observe().
class Histogram {
 public:
  /// `bounds` are the buckets' upper bounds (inclusive), ascending and finite; a last bucket
  /// without a bound is added.
  explicit Histogram(std::vector<double> bounds);
  /// Counts `value` in its bucket; ignores NaN.
  void observe(double value);

  struct Snapshot {
    std::vector<double> bounds;
    std::vector<std::uint64_t> counts;  ///< By bucket, not cumulative; the last has no bound.
    double sum = 0.0;
  };
  [[nodiscard]] Snapshot snapshot() const;

 private:
  std::vector<double> bounds_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> counts_;
  std::atomic<double> sum_ = 0.0;
};

}  // namespace chorus

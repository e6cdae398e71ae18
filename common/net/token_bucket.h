// Limits a rate: `burst` at once, `per_second` in the long run.  The caller supplies the time.
#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/duration.h"

namespace chorus::net {

struct Allowance {
  double per_second = 0.0;
  double burst = 0.0;
};

/// The bucket is full at first.
class TokenBucket {
 public:
  explicit TokenBucket(Allowance allowance) : allowance_(allowance), tokens_(allowance.burst) {}

  [[nodiscard]] bool has(double wanted, SteadyTime now) const { return wanted <= tokens_at(now); }
  [[nodiscard]] bool full(SteadyTime now) const { return has(allowance_.burst, now); }

  /// Takes all wanted tokens, or none and returns false.
  [[nodiscard]] bool take(double wanted, SteadyTime now) {
    if (!has(wanted, now)) return false;
    tokens_ = tokens_at(now) - wanted;
    counted_ = now;
    return true;
  }
  /// Takes tokens even when there are too few, which leaves a debt of at most one burst.
  void charge(double owed) { tokens_ = std::max(tokens_ - owed, -allowance_.burst); }

 private:
  [[nodiscard]] double tokens_at(SteadyTime now) const {
    const double elapsed = std::max(0.0, std::chrono::duration<double>(now - counted_).count());
    return std::min(tokens_ + elapsed * allowance_.per_second, allowance_.burst);
  }

  Allowance allowance_;
  double tokens_;
  SteadyTime counted_{};
};

}  // namespace chorus::net

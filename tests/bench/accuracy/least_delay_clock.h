// The server's former method: the offset from the exchange with the least delay of the last 30 s,
// without a model of the rate, applied only if it exceeds its uncertainty.
#pragma once

#include <deque>

#include "common/time/clock_estimate.h"

namespace chorus::bench {

class LeastDelayClock {
 public:
  void add(const ClockExchange& exchange);
  /// What is added to the stamps of the other host.
  [[nodiscard]] Duration correction(Timestamp now) const;

 private:
  struct Sample {
    Timestamp received;
    Duration ours_minus_theirs;
    Duration uncertainty;
  };
  [[nodiscard]] static Duration grown(const Sample& sample, Timestamp now);
  [[nodiscard]] const Sample* best(Timestamp now) const;
  [[nodiscard]] bool contradicts(const Sample& sample);

  std::deque<Sample> samples_;  ///< Oldest first; uncertainties increase, so the first is the best.
  int contradictions_ = 0;
};

}  // namespace chorus::bench

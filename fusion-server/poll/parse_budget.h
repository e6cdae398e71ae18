// Limits the reading of one sensor's frames to a tenth of the poll thread: after reading for t, the
// sensor rests for 10 t.
#pragma once

#include <algorithm>

#include "common/base/duration.h"

namespace chorus::poll {

class ParseBudget {
 public:
  /// Takes the `cost` of reading just done.  Returns how long to leave the sensor alone: zero while
  /// its debt is below one frame interval, so that an ordinary sensor never rests.
  [[nodiscard]] Duration spend(Duration cost, Duration now) {
    debt_ = std::max(Duration{0}, debt_ - (now - at_)) + kTimes * cost;
    at_ = now;
    return debt_ > kAllowed ? debt_ : Duration{0};
  }

 private:
  static constexpr int kTimes = 10;
  static constexpr Duration kAllowed = std::chrono::milliseconds(30);

  Duration debt_{0};  ///< Time to wait until all reading so far amounts to a tenth.
  Duration at_{0};
};

}  // namespace chorus::poll

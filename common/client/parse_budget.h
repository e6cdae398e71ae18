// Limits the reading of one sensor's frames to a tenth of the poll thread's time: after reading for
// t, the sensor rests for 10 t.
#pragma once

#include <algorithm>

#include "common/base/duration.h"

namespace chorus::client {

class ParseBudget {
 public:
  /// Call this with the `cost` of a reading just done.  Returns how long to leave the sensor alone:
  /// zero while its debt is less than one frame interval, so that an ordinary sensor never rests.
  [[nodiscard]] Duration spend(Duration cost, Duration now) {
    debt_ = std::max(Duration{0}, debt_ - (now - at_)) + kTimes * cost;
    at_ = now;
    return debt_ > kAllowed ? debt_ : Duration{0};
  }

 private:
  static constexpr int kTimes = 10;
  static constexpr Duration kAllowed = std::chrono::milliseconds(30);

  Duration debt_{0};  ///< Time to wait until reading has taken no more than a tenth of all time.
  Duration at_{0};
};

}  // namespace chorus::client

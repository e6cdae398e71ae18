// How long to wait before trying again.  The pause doubles each time, and is short again after a
// long run.
#pragma once

#include <algorithm>

#include "common/base/duration.h"

namespace chorus::camera {

class RestartPause {
 public:
  RestartPause(Duration shortest, Duration longest)
      : shortest_(shortest), longest_(longest), next_(shortest) {}

  /// The pause after a run; `lived`: how long it worked before it failed.
  [[nodiscard]] Duration after(Duration lived) {
    if (lived >= kWell) next_ = shortest_;
    const Duration pause = next_;
    next_ = std::min(2 * next_, longest_);
    return pause;
  }

 private:
  static constexpr Duration kWell = std::chrono::seconds(10);

  Duration shortest_;
  Duration longest_;
  Duration next_;
};

}  // namespace chorus::camera

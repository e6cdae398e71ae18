// The clock of a sensor host as a function of true time.
#pragma once

#include "common/time/timestamp.h"

namespace chorus::synthetic {

/// host = true + offset + drift * (true - origin), plus `step` from `step_at` on.
struct HostClock {
  double offset = 0.0;  ///< [s]
  double drift = 0.0;   ///< [s/s]
  double step = 0.0;    ///< [s]
  Timestamp origin{};
  Timestamp step_at = Timestamp::max();

  [[nodiscard]] Timestamp host_time(Timestamp true_time) const;
};

}  // namespace chorus::synthetic

#include "common/time/clock.h"

namespace chorus {

Timestamp SystemClock::now() const {
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return Timestamp(std::chrono::duration_cast<Duration>(utc) + error_);
}

}  // namespace chorus

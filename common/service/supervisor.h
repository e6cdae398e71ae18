// Tells systemd the state of the service (the sd_notify protocol, without systemd's library): sends
// one datagram per message to the socket that $NOTIFY_SOCKET names.  Without that variable it does
// nothing.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/environment.h"

namespace chorus::service {

class Supervisor {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  explicit Supervisor(const Environment& environment);

  /// Sends "READY=1", "STOPPING=1", "WATCHDOG=1" or "STATUS=..."; false when it was not sent.
  bool tell(std::string_view message) const;

  /// Interval at which "WATCHDOG=1" is due: half of the unit's WatchdogSec; none if the unit has no
  /// watchdog.
  [[nodiscard]] std::optional<std::chrono::microseconds> pulse() const { return pulse_; }

 private:
  std::string socket_;  ///< A path, or "@" and a name in the abstract namespace.
  std::optional<std::chrono::microseconds> pulse_;
};

}  // namespace chorus::service

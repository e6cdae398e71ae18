// Tells systemd how the service is (the protocol of sd_notify, without its library): one datagram a
// message to the socket that $NOTIFY_SOCKET names.  Without that variable nothing is told and
// nobody waits.
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

  /// "READY=1", "STOPPING=1", "WATCHDOG=1" or "STATUS=..."; false when nobody was told.
  bool tell(std::string_view message) const;

  /// How often "WATCHDOG=1" is due: half of what the unit's WatchdogSec allows; nothing without it.
  [[nodiscard]] std::optional<std::chrono::microseconds> pulse() const { return pulse_; }

 private:
  std::string socket_;  ///< A path, or a name in the abstract namespace after "@".
  std::optional<std::chrono::microseconds> pulse_;
};

}  // namespace chorus::service

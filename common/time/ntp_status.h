// What the kernel knows about its own clock, as NTP or chrony set it (adjtimex).
#pragma once

#include "common/base/duration.h"

namespace chorus {

struct NtpStatus {
  bool synchronised = false;  ///< STA_UNSYNC is clear and the kernel reports no TIME_ERROR.
  Duration offset{0};         ///< Offset that is still being corrected; UTC minus this clock.
  Duration max_error{
      0};  ///< Kernel's bound on |UTC - this clock|; grows by 500 ppm until it is set again.
  Duration est_error{0};
  double frequency_ppm = 0.0;  ///< Frequency correction applied by the kernel.

  bool operator==(const NtpStatus&) const = default;
};

/// Reads the kernel's state; needs no privilege.  An unreadable state counts as not synchronised.
[[nodiscard]] NtpStatus read_ntp_status();

}  // namespace chorus

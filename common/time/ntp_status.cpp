#include "common/time/ntp_status.h"

#include <sys/timex.h>

namespace chorus {

NtpStatus read_ntp_status() {
  using std::chrono::microseconds;
  timex state{};
  const int verdict = adjtimex(&state);
  NtpStatus status;
  if (verdict < 0) return status;
  status.synchronised = verdict != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  status.offset = (state.status & STA_NANO) != 0 ? Duration(state.offset)
                                                 : Duration(microseconds(state.offset));
  status.max_error = microseconds(state.maxerror);
  status.est_error = microseconds(state.esterror);
  status.frequency_ppm = static_cast<double>(state.freq) / 65536.0;  // scaled ppm, adjtimex(2)
  return status;
}

}  // namespace chorus

// `/clock`: the service's UTC now, and what the kernel knows about its clock.
#pragma once

#include "common/resource/node.h"
#include "common/time/ntp_status.h"

namespace chorus::resource {

struct ClockState {
  Timestamp now;
  NtpStatus ntp;
};

[[nodiscard]] Node clock_node(const ClockState& clock);

}  // namespace chorus::resource

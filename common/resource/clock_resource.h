// `/clock`: the service's UTC now and what the kernel knows of its clock.
#pragma once

#include <string_view>

#include "common/resource/node.h"
#include "common/time/ntp_status.h"

namespace chorus::resource {

struct ClockState {
  Timestamp now;
  NtpStatus ntp;
};

[[nodiscard]] Node clock_node(const ClockState& clock);

/// A document without `now` is refused; an unknown NTP state reads as "not synchronised".
[[nodiscard]] Result<ClockState> read_clock(std::string_view bytes, Format format);

}  // namespace chorus::resource

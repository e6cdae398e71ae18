// When frames are taken and arrive, which are lost, and what the host's clock says.  Seconds.
#pragma once

#include <cstdint>

#include "common/synthetic/host_clock.h"
#include "common/synthetic/kinect/joint_error.h"
#include "common/time/timestamp.h"

namespace chorus::synthetic::kinect {

/// A host's clock drawn from the profile; some step once, some time after the origin.
[[nodiscard]] HostClock draw_clock(const ClockError& clock, Timestamp origin,
                                   const ErrorKeys& keys);

/// When frame `number` (periods since the epoch) is truly exposed.
[[nodiscard]] Timestamp exposure(const Delivery& delivery, std::uint64_t number,
                                 const ErrorKeys& keys);
/// The first frame exposed at or after the instant.
[[nodiscard]] std::uint64_t first_frame(const Delivery& delivery, Timestamp instant,
                                        const ErrorKeys& keys);
/// Lost on the way, or never taken: the odd ones of an episode at half the rate.
[[nodiscard]] bool is_dropped(const Delivery& delivery, std::uint64_t number,
                              const ErrorKeys& keys);
/// The tracker has lost this person for the moment.
[[nodiscard]] bool is_lost(const Delivery& delivery, double time, const ErrorKeys& keys);
/// Exposure to arrival.
[[nodiscard]] Duration latency(const Delivery& delivery, std::uint64_t number,
                               const ErrorKeys& keys);

}  // namespace chorus::synthetic::kinect

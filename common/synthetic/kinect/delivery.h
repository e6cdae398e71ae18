// When frames are exposed and when they arrive, which ones are lost, and what the sensor host's
// clock shows.
#pragma once

#include <cstdint>

#include "common/synthetic/host_clock.h"
#include "common/synthetic/kinect/joint_error.h"
#include "common/time/timestamp.h"

namespace chorus::synthetic::kinect {

/// Draws a host's clock from the profile.  Some clocks jump once, at a random time after the
/// origin.
[[nodiscard]] HostClock draw_clock(const ClockError& clock, Timestamp origin,
                                   const ErrorKeys& keys);

/// The true time at which frame `number` is exposed; a frame's number is that of its period since
/// the epoch.
[[nodiscard]] Timestamp exposure(const Delivery& delivery, std::uint64_t number,
                                 const ErrorKeys& keys);
/// The first frame exposed at or after the instant.
[[nodiscard]] std::uint64_t first_frame(const Delivery& delivery, Timestamp instant,
                                        const ErrorKeys& keys);
/// True if the frame was lost on the way, or never taken: while a sensor runs at half its rate, it
/// takes only frames with even numbers.
[[nodiscard]] bool is_dropped(const Delivery& delivery, std::uint64_t number,
                              const ErrorKeys& keys);
/// True while the SDK has lost this person.  `time`: seconds since the epoch.
[[nodiscard]] bool is_lost(const Delivery& delivery, double time, const ErrorKeys& keys);
/// The delay between exposure and arrival.
[[nodiscard]] Duration latency(const Delivery& delivery, std::uint64_t number,
                               const ErrorKeys& keys);

}  // namespace chorus::synthetic::kinect

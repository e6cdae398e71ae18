// Turning one layer of the sensor model up, down or off: stress sweeps and ablations.
#pragma once

#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// The layers, as with_source() groups them.
enum class Source { Visibility, Yaw, Bias, Coloured, White, Gross, Delivery, Clock };

/// The profile with one source of error multiplied: 0 switches it off, 1 leaves it.  Probabilities
/// stop at 1.  Of the yaw only the lag grows; the flip is there or not.  Latency is no error and
/// stays.
[[nodiscard]] Profile with_source(Profile profile, Source source, double factor);

}  // namespace chorus::synthetic::kinect

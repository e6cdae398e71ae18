// OpenCV's hand-eye calibration as a baseline.
#pragma once

#include <optional>

#include "common/evaluation/park.h"

namespace chorus::bench {

/// calibrateHandEye with CALIB_HAND_EYE_PARK on at most 60 poses, of which it takes all pairs; q^G
/// as the mean over the poses.  Debian's 4.6 precedes the fix of opencv#24871.  Nothing where it
/// fails.
[[nodiscard]] std::optional<evaluation::ParkCalibration> hand_eye_by_opencv(
    const evaluation::OrientationPairs& pairs);

}  // namespace chorus::bench

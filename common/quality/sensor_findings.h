// What a recording shows to be wrong with its sensors.
//
// Sensors are compared with one another: each figure minus the median of all.  What
// one sensor does wrong moves the fused bodies too, and so the residuals of all others, alike.
#pragma once

#include <vector>

#include "common/quality/quality_report.h"

namespace chorus::quality {

/// Whether people were seen too briefly to tell errors of places and clocks from their posture.
[[nodiscard]] bool too_short_for_trends(const RecordingQuality& quality);

/// Of all sensors, in the order of their ids.  Of two sensors the figures do not tell which one it
/// is: such a finding names both.
[[nodiscard]] std::vector<Finding> sensor_findings(const RecordingQuality& quality);

}  // namespace chorus::quality

// The figures of a recording as a report: what each means, its limit, and what to do.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "common/quality/fused_quality.h"
#include "common/quality/sensor_quality.h"
#include "common/report/report.h"

namespace chorus::quality {

struct RecordingQuality {
  std::string name;  ///< File or address.
  FusedQuality fused;
  std::map<SensorId, SensorQuality> sensors;      ///< Empty: only fused frames were recorded.
  std::array<ViewError, kJointCount> views = {};  ///< Of the fused joints; 0 and NaN: unknown.
  std::string verdict;                            ///< Of the registration; empty: unknown.
  std::vector<std::string> notes;                 ///< What was left out while reading.
};

/// A fault that the figures show, worst first.
struct Finding {
  report::Judgement judgement = report::Judgement::Doubtful;
  std::string what;    ///< "s3 stands 60 mm from where it was registered"
  std::string advice;  ///< "run chorus register"
};

/// So many findings the verdict names.
inline constexpr std::size_t kMostInVerdict = 5;

/// What the figures show to be wrong, worst first; empty: nothing.
[[nodiscard]] std::vector<Finding> findings_of(const RecordingQuality& quality);

/// What the figures cannot tell of this recording, and why: no registration, one sensor, no time in
/// common, joints that its sensors never report.
[[nodiscard]] std::vector<std::string> remarks_of(const RecordingQuality& quality);

/// The whole report; its verdict names the findings.
[[nodiscard]] report::Report report_of(const RecordingQuality& quality);

}  // namespace chorus::quality

// Finds roughly by how much two tracks of one motion are shifted in time.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/alignment/trajectory_alignment.h"
#include "common/base/result.h"

namespace chorus::alignment {

/// A trace at a time between two of its points that are at most `max_gap` apart; none elsewhere.
[[nodiscard]] std::optional<TracePoint> trace_at(const Trace& trace, double time, double max_gap);

/// The offset, added to the reference's stamps, at which yaw and translation make the two traces
/// most alike, to about 0.05 s.  Errors as align_traces().
[[nodiscard]] Result<double> rough_offset(const Trace& ours, const Trace& reference,
                                          const AlignmentConfig& config);

}  // namespace chorus::alignment

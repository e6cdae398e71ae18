// Reads fused frames from any source: our recordings, NDJSON of `chorus fuse`, or a running server.
#pragma once

#include <chrono>
#include <string>

#include "common/base/result.h"
#include "common/record/fused_frames.h"

namespace chorus::ctl {

/// Passes all fused frames of `source` on, one by one.  An http:// or https:// address is a fusion
/// server, or anything else with a /frame in world space, and is read for the time `listen`; other
/// sources are read by record::each_fused_frame().  If a server fails after its first frame, the
/// frames received until then are kept.
[[nodiscard]] Result<record::Notes> each_fused_frame(const std::string& source,
                                                     std::chrono::milliseconds listen,
                                                     const record::TakeFrame& take);

}  // namespace chorus::ctl

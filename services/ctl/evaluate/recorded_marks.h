// The marks of a recording, for the phases of a task.
#pragma once

#include <string>

#include "common/base/result.h"
#include "common/ergonomics/task.h"
#include "common/time/timestamp.h"

namespace chorus::ctl {

struct FusedSpan {
  Timestamp start;       ///< Of the first fused frame.
  double seconds = 0.0;  ///< From the first to the last one.
};

/// Of a recording or a folder of them: those in marks.json beside it, which the page edits, or,
/// without that file, those in the recording itself.  None of any other source.
[[nodiscard]] Result<ergonomics::Marks> marks_of(const std::string& source, const FusedSpan& span);

}  // namespace chorus::ctl

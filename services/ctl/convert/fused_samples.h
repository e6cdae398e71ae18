// Reads fused frames in the form that make_take() takes.
#pragma once

#include <chrono>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/exporters/take.h"
#include "common/record/fused_frames.h"

namespace chorus::ctl {

using FusedSamples = std::vector<exporters::FusedSample>;

struct FusedFrames {
  FusedSamples samples;
  record::Notes notes;
};

/// Reads all fused frames of `source`, as each_fused_frame() does.
[[nodiscard]] Result<FusedFrames> read_fused_frames(const std::string& source,
                                                    std::chrono::milliseconds listen);

/// Reads lines as written by record::frame_line(); `origin` names the source in errors.
[[nodiscard]] Result<FusedSamples> read_fused_lines(std::istream& lines, const std::string& origin);

}  // namespace chorus::ctl

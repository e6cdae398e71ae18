// Fused frames from any source: our recordings, NDJSON of `chorus fuse`, a running server.
#pragma once

#include <chrono>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/exporters/take.h"
#include "common/resource/frame_resource.h"

namespace chorus::client {

using FusedSamples = std::vector<exporters::FusedSample>;

struct FusedFrames {
  FusedSamples samples;
  std::vector<std::string> notes;  ///< What is missing, as text: damage, gaps, failures.
};

/// The kind of source follows from `source`: http://... is a fusion server (or anything with a
/// /frame in world space), read for `listen`; "-" is NDJSON on standard input; a file that starts
/// like MCAP, or a folder of .mcap files, is a recording; any other file is NDJSON. Frames in a
/// sensor's own space are refused: they must be fused first.  If a server fails later on, the
/// frames received before are kept.
[[nodiscard]] Result<FusedFrames> read_fused_frames(const std::string& source,
                                                    std::chrono::milliseconds listen);

/// A frame as NDJSON: its /frame document on one line, with the line end.
[[nodiscard]] std::string frame_line(const resource::FrameResource& frame);

/// Reads lines as frame_line() writes them; skips blank ones.  `origin` names the text in errors.
[[nodiscard]] Result<FusedSamples> read_fused_lines(std::istream& lines, const std::string& origin);

}  // namespace chorus::client

// Reads fused frames from any source: our recordings, NDJSON of `chorus fuse`, or a running server.
#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/exporters/take.h"
#include "common/resource/frame_resource.h"

namespace chorus::client {

using FusedSamples = std::vector<exporters::FusedSample>;

/// Human-readable: what is missing because of damage, gaps or failures.
using Notes = std::vector<std::string>;

struct FusedFrames {
  FusedSamples samples;
  Notes notes;
};

/// Takes a frame as it was read; `at` says where, for messages.  An error ends the reading.
using TakeFrame =
    std::function<Result<void>(const resource::FrameResource& frame, const std::string& at)>;

/// Passes all fused frames of `source` on, one by one.  An http:// or https:// address is a fusion
/// server, or anything else with a /frame in world space, and is read for the time `listen`; "-" is
/// NDJSON on standard input; a file that begins like MCAP, or a folder of .mcap files, is a
/// recording; any other file is NDJSON.  Frames in sensor space are refused: they must be fused
/// first.  If a server fails after its first frame, the frames received until then are kept.
[[nodiscard]] Result<Notes> each_fused_frame(const std::string& source,
                                             std::chrono::milliseconds listen,
                                             const TakeFrame& take);

/// Reads all fused frames of `source`, as each_fused_frame() does, in the form that make_take()
/// takes.
[[nodiscard]] Result<FusedFrames> read_fused_frames(const std::string& source,
                                                    std::chrono::milliseconds listen);

/// A frame as a line of NDJSON: its /frame document on one line, including the line end.
[[nodiscard]] std::string frame_line(const resource::FrameResource& frame);

/// Reads lines as written by frame_line(); skips blank lines.  `origin` names the source in errors.
[[nodiscard]] Result<FusedSamples> read_fused_lines(std::istream& lines, const std::string& origin);

}  // namespace chorus::client

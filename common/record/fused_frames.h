// Reads fused frames one by one from recordings, and from NDJSON as `chorus fuse` writes it.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/resource/frame_resource.h"

namespace chorus::record {

/// Human-readable: what is missing because of damage, gaps or failures.
using Notes = std::vector<std::string>;

/// Takes a frame as it was read; `at` says where, for messages.  An error ends the reading.
using TakeFrame =
    std::function<Result<void>(const resource::FrameResource& frame, const std::string& at)>;

/// Passes all fused frames of `source` on.  A file that begins like MCAP, or a folder of .mcap
/// files, is a recording; any other file is NDJSON; "-" is NDJSON on standard input.  Frames in
/// sensor space are refused: they must be fused first.
[[nodiscard]] Result<Notes> each_fused_frame(const std::string& source, const TakeFrame& take);

/// Passes on the frames of lines as written by frame_line(); skips blank lines.  `origin` names the
/// source in errors.
[[nodiscard]] Result<Notes> each_fused_line(std::istream& lines, const std::string& origin,
                                            const TakeFrame& take);

/// A frame as a line of NDJSON: its /frame document on one line, including the line end.
[[nodiscard]] std::string frame_line(const resource::FrameResource& frame);

/// Reads a /frame document in JSON; Unsupported if it is in sensor space.  `at` names it in errors.
[[nodiscard]] Result<resource::FrameResource> read_fused_frame(std::string_view json,
                                                               const std::string& at);

}  // namespace chorus::record

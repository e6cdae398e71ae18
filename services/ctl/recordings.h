// Which recordings a command line means: folders stand for the .mcap files in them.
#pragma once

#include <filesystem>
#include <vector>

#include "common/base/result.h"
#include "common/record/session_reader.h"

namespace chorus::ctl {

/// Sorted by name within a folder; each given file as it is.  Nothing found is an error.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(
    const std::vector<std::filesystem::path>& inputs);

/// Read whole; refuses none at all, and two of the same sensor unless they are parts of one
/// recording.
[[nodiscard]] Result<record::Session> read_recordings(
    const std::vector<std::filesystem::path>& files);

}  // namespace chorus::ctl

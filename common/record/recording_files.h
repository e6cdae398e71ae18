// Finds the files of a recording, and the order in which they were written.
#pragma once

#include <filesystem>
#include <vector>

#include "common/base/result.h"

namespace chorus::record {

/// The file itself, or the .mcap files in a folder, ordered by name.
[[nodiscard]] Result<std::vector<std::filesystem::path>> recording_files(
    const std::filesystem::path& path);

/// The files that are named, and those in the folders that are named, sorted by name within each
/// folder.  Errors: an input does not exist or cannot be read, or there is no file.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(
    const std::vector<std::filesystem::path>& inputs);

/// Orders files by the log time of their first message; files without messages come first.
[[nodiscard]] std::vector<std::filesystem::path> in_log_order(
    std::vector<std::filesystem::path> files);

}  // namespace chorus::record

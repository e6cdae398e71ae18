// The files of a recording: which they are, and in which order they were written.
#pragma once

#include <filesystem>
#include <vector>

#include "common/base/result.h"

namespace chorus::record {

/// The file itself, or the .mcap files of a folder in order of their names.
[[nodiscard]] Result<std::vector<std::filesystem::path>> recording_files(
    const std::filesystem::path& path);

/// By the log time of their first message, whatever their names; those without messages come first.
[[nodiscard]] std::vector<std::filesystem::path> in_log_order(
    std::vector<std::filesystem::path> files);

}  // namespace chorus::record

// Whole files: read within a bound, replaced at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus {

/// NotFound when it is not there, TooLarge beyond max_bytes; pipes are read to their end.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::uintmax_t max_bytes);

/// Afterwards, and after a crash or a power cut too, the old text is there or the new one, whole:
/// it is written beside, synced and renamed.  What is no plain file (a pipe, /dev/null) is written
/// to as it is.
[[nodiscard]] Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

/// What was made or renamed in a folder outlives a power cut; best effort.  "" is the current one.
void sync_folder(const std::filesystem::path& folder);

}  // namespace chorus

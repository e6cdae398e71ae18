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

/// Even after a crash or a power cut the file holds the whole old text or the whole new one: the
/// new one is written to a second file, synced and renamed.  A pipe or a device (/dev/null) is
/// written to directly.
[[nodiscard]] Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

/// Syncs a folder, so that files made or renamed in it survive a power cut; best effort.  "": the
/// current folder.
void sync_folder(const std::filesystem::path& folder);

}  // namespace chorus

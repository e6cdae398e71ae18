// Whole files: read up to a limit, replaced atomically.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus {

/// NotFound when the file does not exist, TooLarge beyond max_bytes; pipes are read to their end.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::uintmax_t max_bytes);

/// Even after a crash or a power cut the file holds either the whole old text or the whole new one:
/// the new text is written to a second file, synced and renamed.  A pipe or a device (/dev/null) is
/// written directly.
[[nodiscard]] Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

/// Syncs a folder, so that files created or renamed in it survive a power cut; best effort.  "":
/// the current folder.
void sync_folder(const std::filesystem::path& folder);

}  // namespace chorus

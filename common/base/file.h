// Whole files: reads them up to a size limit, replaces them atomically.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus {

/// The file's bytes; a pipe is read to its end.  NotFound when the file does not exist, TooLarge
/// when it has more than max_bytes, Io when it is a folder or cannot be read.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::uintmax_t max_bytes);

/// Replaces the content of a file.  Even after a crash or a power cut the file holds either the
/// whole old content or the whole new one: the new content is written to a second file, which is
/// synced and then renamed.  A pipe or a device (/dev/null) is written directly.
[[nodiscard]] Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

/// Syncs a folder, so that files created or renamed in it survive a power cut; "" is the current
/// folder.  Failures are ignored.
void sync_folder(const std::filesystem::path& folder);

}  // namespace chorus

// Whole files: reads them up to a size limit, replaces them atomically.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus {

/// The bytes of a regular file.  NotFound when there is none, TooLarge when it has more than
/// max_bytes, Io when it is something else (a folder, a pipe, a device, a link to itself) or cannot
/// be read.  Never waits for anybody.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::uintmax_t max_bytes);

/// The same for a file that a person named, which may also be a pipe (`--config <(...)`) or a
/// device; a pipe is read to its end, but not waited for longer than ten seconds.
[[nodiscard]] Result<std::string> read_file_or_pipe(const std::filesystem::path& path,
                                                    std::uintmax_t max_bytes);

/// True if the folder has an entry of this name, whatever it is: also a link that leads nowhere or
/// to itself, which std::filesystem::exists does not see.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// Replaces the content of a file.  Even after a crash or a power cut the file holds either the
/// whole old content or the whole new one: the new content is written to a second file, which is
/// synced and then renamed.  A pipe or a device (/dev/null) is written directly.
[[nodiscard]] Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

/// Syncs a folder, so that files created or renamed in it survive a power cut; "" is the current
/// folder.  Failures are ignored.
void sync_folder(const std::filesystem::path& folder);

}  // namespace chorus

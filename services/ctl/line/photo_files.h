// Photos on the command line: files, and folders of files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

/// By the ending.  Photos in HEIC count, although they cannot be read: the error says what to do
/// about them.
[[nodiscard]] bool is_photo(const std::filesystem::path& file);

/// The sources, with each folder replaced by the photos in it, ordered by name.  NotFound for a
/// folder without photos.
[[nodiscard]] Result<std::vector<std::string>> photo_files(const std::vector<std::string>& sources);

}  // namespace chorus::ctl

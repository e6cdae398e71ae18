// Files that a command writes as a whole; "-" is standard output.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

/// Replaces an existing file only after everything has been written.
[[nodiscard]] Result<void> write_text(const std::string& file, std::string_view text);

/// Call this before the work begins.  Refuses a file that is one of the inputs, and any recording
/// that already exists.  Inputs that are not files ("-", a URL, "") are ignored.
[[nodiscard]] Result<void> may_write(const std::string& file,
                                     const std::vector<std::filesystem::path>& inputs);

/// True if both name one file, which need not exist, or both are "-".
[[nodiscard]] bool same_file(const std::string& one, const std::string& other);

/// Conflict when the file exists; "-" never does.
[[nodiscard]] Result<void> may_create(const std::string& file);

}  // namespace chorus::ctl

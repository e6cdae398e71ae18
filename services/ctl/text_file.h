// What a command writes as whole files; "-" is standard output.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

/// Replaces what was there only when all is written.
[[nodiscard]] Result<void> write_text(const std::string& file, std::string_view text);

/// Asked before the work begins: refuses a file that is one of the inputs, and any recording that
/// is there already.  Inputs that are no files ("-", a URL, "") are none.
[[nodiscard]] Result<void> may_write(const std::string& file,
                                     const std::vector<std::filesystem::path>& inputs);

}  // namespace chorus::ctl

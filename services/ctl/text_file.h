// Small text files, whole; "-" is standard output.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus::ctl {

/// At most 16 MB: configs and registrations.
[[nodiscard]] Result<std::string> read_text(const std::string& file);

[[nodiscard]] Result<void> write_text(const std::string& file, std::string_view text);

}  // namespace chorus::ctl

// The version of Chorus, for `--version`.
#pragma once

#include <string_view>

namespace chorus {

/// "0.1.0"; the whole project has one version.
[[nodiscard]] std::string_view version();

}  // namespace chorus

// Which Chorus this is, for `--version`.
#pragma once

#include <string_view>

namespace chorus {

/// "0.1.0", of the whole project.
[[nodiscard]] std::string_view version();

}  // namespace chorus

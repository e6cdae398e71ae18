// Finds the folders of files that come with the programs: the viewer, the runner, the capture page.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus {

/// The folder `name`, recognised by the file `sign` in it.  Looks among the installed files, next
/// to the sources that the program was built from, and in the working directory's `services`.
/// NotFound when there is none.
[[nodiscard]] Result<std::string> shipped_folder(std::string_view name, std::string_view sign);

}  // namespace chorus

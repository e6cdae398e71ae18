// Files that `chorus init` creates on a host, for the services or for root only.
#pragma once

#include <string>

#include "common/base/result.h"

namespace chorus::ctl {

enum class Readers {
  Services,  ///< Group "chorus" if it exists and we are root; mode 0640.
  Owner,     ///< 0600
  Everybody  ///< 0644
};
enum class Overwriting { Never, Yes };

/// "-": standard output.  InvalidArgument when the file exists and may not be overwritten.
[[nodiscard]] Result<void> write_file(const std::string& file, const std::string& text,
                                      Readers readers,
                                      Overwriting overwriting = Overwriting::Never);

/// Makes a folder and its parents; a new one is 0700 or, for the services' group, 0751.
[[nodiscard]] Result<void> make_folder(const std::string& folder, Readers readers);

}  // namespace chorus::ctl

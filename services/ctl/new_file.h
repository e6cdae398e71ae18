// Files that `chorus init` makes on a host: for the services, or for root alone.
#pragma once

#include <string>

#include "common/base/result.h"

namespace chorus::ctl {

enum class Readers {
  Services,  ///< The user and the group "chorus", where there is one and we are root (0640).
  Owner,     ///< 0600
  Everybody  ///< 0644
};
enum class Overwriting { Never, Yes };

/// "-": standard output.  InvalidArgument when it is there already and is not to be overwritten.
[[nodiscard]] Result<void> write_file(const std::string& file, const std::string& text,
                                      Readers readers,
                                      Overwriting overwriting = Overwriting::Never);

/// A folder, with those above it; 0700 or, for services, 0750 of their group when it is new.
[[nodiscard]] Result<void> make_folder(const std::string& folder, Readers readers);

}  // namespace chorus::ctl

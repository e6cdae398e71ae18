// Child processes that end when we end.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

struct Child {
  std::string label;  ///< Name in messages.
  std::vector<std::string> command;
};

/// Starts all children and waits.  SIGINT or SIGTERM to us stops them, which is a success.  When
/// one ends by itself, the others are stopped, and the result is a success if it exited with 0,
/// otherwise an error that names it.
[[nodiscard]] Result<void> run_children(const std::vector<Child>& children);

}  // namespace chorus::ctl

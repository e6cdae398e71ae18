// Runs another program and takes what it says, for no longer and no more than allowed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/duration.h"
#include "common/base/result.h"

namespace chorus {

/// The program of this name in the folder of our own program; if there is none, the bare name,
/// which is searched for in $PATH.
[[nodiscard]] std::filesystem::path sibling_program(const std::string& name);

struct AskLimits {
  Duration patience = std::chrono::seconds(10);
  std::size_t most_bytes = 4u << 20;
};

struct Asked {
  int code = 0;            ///< Its exit code; 127: there is no such program; 128 + signal.
  std::string said;        ///< Standard output and standard error, up to most_bytes.
  bool cut_short = false;  ///< It was ended: it took too long or said too much.
};

/// `command`: the program, looked for in $PATH, and its arguments.  The program and its children
/// are ended when a limit is reached.  Io: it could not be started at all.
[[nodiscard]] Result<Asked> ask_program(const std::vector<std::string>& command,
                                        const AskLimits& limits = {});

}  // namespace chorus

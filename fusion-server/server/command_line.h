// The command line of chorus-fusion.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace chorus::server {

/// Exit codes of chorus-fusion.
inline constexpr int kExitStopped = 0;   ///< Asked to stop, and stopped.
inline constexpr int kExitMistaken = 2;  ///< Command line, configuration, or a port in use.

struct CommandLine {
  std::optional<int> exit;  ///< Set: nothing is to be run (help, or a mistake already explained).
  std::string config;
  std::vector<std::string> overrides;  ///< "path=value"
  std::string log_format = "text";
  std::string log_level = "info";
  bool check_only = false;  ///< Read the configuration, say whether it is good, and leave.
};

[[nodiscard]] CommandLine read_command_line(int argc, const char* const* argv);

}  // namespace chorus::server

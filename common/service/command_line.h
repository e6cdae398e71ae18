// Reads the command line of a service: all services have the same options, wording and exit codes.
//
//   --config FILE   --set PATH=VALUE   --port N   --log-level L   --log-format F   --check
//   --version   --help   and the service's own shortcuts
//
// Every option that sets something assigns to a configuration key, so the file and the command line
// can set the same things.  The command line overrides the file; --set overrides the other options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/service/config_source.h"

namespace chorus::service {

inline constexpr int kExitStopped = 0;   ///< Stopped on request, or had nothing to run.
inline constexpr int kExitFailed = 1;    ///< Failed while running.
inline constexpr int kExitMistaken = 2;  ///< Wrong command line or configuration, or a port in use.

/// An option that assigns to a configuration key.
struct Shortcut {
  std::string option;  ///< "--id"
  std::string key;     ///< "id"
  std::string help;
  bool quoted = true;        ///< The value is a string, even if it looks like a number.
  std::string implied = {};  ///< An assignment to make first, such as device.kind="replay".
};

/// How a program describes itself in --help and the manual.
struct About {
  std::string name;  ///< "chorus-sensor"
  std::string description;
  std::string examples;  ///< Indented lines, each with its line end.
  std::vector<Shortcut> shortcuts = {};
  std::string files = {};  ///< For the manual page: lines "NAME meaning".
};

struct CommandLine {
  /// If set, the program must exit with this code (after --help, or a mistake that has been
  /// reported).
  std::optional<int> exit;
  ConfigSource source;
  bool check_only = false;  ///< True: only check the configuration, then exit.
};

[[nodiscard]] CommandLine read_command_line(const About& about, int argc, const char* const* argv);

}  // namespace chorus::service

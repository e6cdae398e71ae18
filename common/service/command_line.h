// The command line of a service: the same options, words and exit codes for each of them.
//
//   --config FILE   --set PATH=VALUE   --port N   --log-level L   --log-format F   --check
//   --version   --help   and the service's own shortcuts
//
// Every option that sets something is an assignment to a configuration key, so the file and the
// command line know the same things.  The command line wins over the file, and --set over the other
// options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/service/config_source.h"

namespace chorus::service {

inline constexpr int kExitStopped = 0;   ///< Stopped on request, or had nothing to run.
inline constexpr int kExitFailed = 1;    ///< Failed while running.
inline constexpr int kExitMistaken = 2;  ///< Wrong command line or configuration, or a port in use.

/// An option that is an assignment.
struct Shortcut {
  std::string option;  ///< "--id"
  std::string key;     ///< "id"
  std::string help;
  bool quoted = true;        ///< Its value is a text, even when it looks like a number.
  std::string implied = {};  ///< An assignment that is made first: device.kind="replay".
};

/// What a program says about itself.
struct About {
  std::string name;  ///< "chorus-sensor"
  std::string description;
  std::string examples;  ///< Lines, indented, each with its end.
  std::vector<Shortcut> shortcuts = {};
  std::string files = {};  ///< For the manual page: lines "NAME meaning".
};

struct CommandLine {
  /// Set: do not run (help, or a mistake that has been explained already).
  std::optional<int> exit;
  ConfigSource source;
  bool check_only = false;  ///< Check the configuration and leave.
};

[[nodiscard]] CommandLine read_command_line(const About& about, int argc, const char* const* argv);

}  // namespace chorus::service

// The command line of a service: the same options, words and exit codes for each of them.
//
//   --config FILE   --set PATH=VALUE   --port N   --log-level L   --log-format F   --check
//   --version   --help   and the service's own shortcuts
//
// Every option that sets something stands for an assignment to a key of the configuration, so file
// and command line know the same things; the command line wins, and of it --set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/service/config_source.h"

namespace chorus::service {

inline constexpr int kExitStopped = 0;   ///< Asked to stop, and stopped; or nothing was to be run.
inline constexpr int kExitFailed = 1;    ///< Broke down while running.
inline constexpr int kExitMistaken = 2;  ///< Command line, configuration, or a port in use.

/// An option that stands for an assignment.
struct Shortcut {
  std::string option;  ///< "--id"
  std::string key;     ///< "id"
  std::string help;
  bool quoted = true;        ///< Its value is a text, even when it looks like a number.
  std::string implied = {};  ///< An assignment that goes before: device.kind="replay".
};

/// What a program says of itself.
struct About {
  std::string name;  ///< "chorus-sensor"
  std::string description;
  std::string examples;  ///< Lines, indented, each with its end.
  std::vector<Shortcut> shortcuts = {};
};

struct CommandLine {
  std::optional<int> exit;  ///< Set: nothing is to be run (help, or a mistake already explained).
  ConfigSource source;
  bool check_only = false;  ///< Read the configuration, say whether it is good, and leave.
};

[[nodiscard]] CommandLine read_command_line(const About& about, int argc, const char* const* argv);

}  // namespace chorus::service

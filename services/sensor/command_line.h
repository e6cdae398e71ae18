// The command line of chorus-sensor.
#pragma once

#include <optional>
#include <string>

#include "services/sensor/sensor_config.h"

namespace chorus::sensor_service {

/// Exit codes of chorus-sensor.
inline constexpr int kExitStopped = 0;   ///< Asked to stop, and stopped.
inline constexpr int kExitFailed = 1;    ///< Broke down while running.
inline constexpr int kExitMistaken = 2;  ///< Command line, configuration, or a port in use.

struct CommandLine {
  std::optional<int> exit;  ///< Set: nothing is to be run (help, or a mistake already explained).
  SetupSource source;
  bool check_only = false;  ///< Read the configuration, say whether it is good, and leave.
};

[[nodiscard]] CommandLine read_command_line(int argc, const char* const* argv);

}  // namespace chorus::sensor_service

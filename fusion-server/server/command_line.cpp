#include "fusion-server/server/command_line.h"

#include <CLI/CLI.hpp>

namespace chorus::server {
namespace {

constexpr const char* kDescription =
    "chorus-fusion: polls body-tracking sensors, registers and fuses them, and answers as one "
    "tracker.";

constexpr const char* kFooter =
    "Examples:\n"
    "  chorus-fusion --config deploy/config/fusion.json\n"
    "  chorus-fusion --config deploy/config/fusion.json --set outputs.vrpn.enabled=true\n"
    "SIGHUP reads the file again; SIGTERM or Ctrl-C stops.\n"
    "Exit codes: 0 stopped when asked to, 2 wrong options, configuration or port in use.";

}  // namespace

CommandLine read_command_line(int argc, const char* const* argv) {
  CLI::App app{kDescription, "chorus-fusion"};
  app.footer(kFooter);
  CommandLine out;
  app.add_option("--config", out.config, "Configuration file (deploy/config/fusion.json)")
      ->required();
  app.add_option("--set", out.overrides, "PATH=VALUE, such as http.port=8090; repeatable")
      ->take_all();
  app.add_option("--log-format", out.log_format, "text or json");
  app.add_option("--log-level", out.log_level, "debug, info, warn or error");
  app.add_flag("--check", out.check_only, "Say whether the configuration is good, and end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    out.exit = app.exit(error) == 0 ? kExitStopped : kExitMistaken;
  }
  return out;
}

}  // namespace chorus::server

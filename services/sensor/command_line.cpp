#include "services/sensor/command_line.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace chorus::sensor_service {

namespace {

constexpr const char* kDescription =
    "chorus-sensor: one body-tracking device as linked-data REST resources.\n"
    "Without options: a simulated sensor on http://127.0.0.1:8081/.";

constexpr const char* kFooter =
    "Examples:\n"
    "  chorus-sensor --config deploy/config/sensor.json\n"
    "  chorus-sensor --port 8082 --id s2 --set device.simulated.ring.index=1\n"
    "  chorus-sensor --recording walk.mcap --set device.replay.speed=0.5\n"
    "SIGHUP reads the file again; SIGTERM or Ctrl-C stops.\n"
    "Exit codes: 0 stopped when asked to, 1 broke down, 2 wrong options, configuration or port in "
    "use.";

/// Shortcuts stand for assignments; texts are quoted so that `--id 7` stays a text.
struct Shortcuts {
  std::string id, device, recording, log_level, log_format;
  std::optional<int> port;
};

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<std::string> assignments_of(const Shortcuts& given) {
  std::vector<std::string> out;
  if (!given.id.empty()) out.push_back("id=" + quoted(given.id));
  if (given.port) out.push_back("http.port=" + std::to_string(*given.port));
  if (!given.recording.empty()) {
    out.emplace_back("device.kind=\"replay\"");
    out.push_back("device.replay.recording=" + quoted(given.recording));
  }
  if (!given.device.empty()) out.push_back("device.kind=" + quoted(given.device));
  if (!given.log_level.empty()) out.push_back("log.level=" + quoted(given.log_level));
  if (!given.log_format.empty()) out.push_back("log.format=" + quoted(given.log_format));
  return out;
}

}  // namespace

CommandLine read_command_line(int argc, const char* const* argv) {
  CLI::App app{kDescription, "chorus-sensor"};
  app.footer(kFooter);
  CommandLine out;
  Shortcuts given;
  std::vector<std::string> sets;
  app.add_option("--config", out.source.config_path,
                 "JSON file with comments; absent: all defaults");
  app.add_option("--set", sets, "Overrides one key: path=value; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  app.add_option("--id", given.id, "Sensor id (id)");
  app.add_option("--port", given.port, "Port; 0 takes any free one (http.port)");
  app.add_option("--device", given.device, "simulated or replay (device.kind)");
  app.add_option("--recording", given.recording, "Replays this file (device.replay.recording)");
  app.add_option("--log-level", given.log_level, "debug, info, warn or error (log.level)");
  app.add_option("--log-format", given.log_format, "text or json (log.format)");
  app.add_flag("--check", out.check_only, "Only says whether the configuration is good");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    out.exit = app.exit(error) == 0 ? kExitStopped : kExitMistaken;
    return out;
  }
  out.source.assignments = assignments_of(given);
  out.source.assignments.insert(out.source.assignments.end(), sets.begin(), sets.end());
  return out;
}

}  // namespace chorus::sensor_service

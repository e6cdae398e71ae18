#include "common/service/command_line.h"

#include <cstdio>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/version.h"
#include "common/service/manual.h"

namespace chorus::service {
namespace {

std::string footer(const About& about) {
  return "Examples:\n" + about.examples +
         "SIGHUP reads the file again; SIGTERM or Ctrl-C stops.\n"
         "Exit codes: 0 stopped when asked to, 1 broke down, 2 wrong options, configuration or "
         "port in use.";
}

/// Puts a value in quotes, so that the 7 of `--id 7` stays a string.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<Shortcut> shortcuts_of(const About& about) {
  std::vector<Shortcut> all{
      {"--port", "http.port", "Port; 0 takes any free one (http.port)", false},
      {"--log-level", "log.level", "debug, info, warn or error (log.level)"},
      {"--log-format", "log.format", "text or json (log.format)"}};
  all.insert(all.end(), about.shortcuts.begin(), about.shortcuts.end());
  return all;
}

void assign(const Shortcut& shortcut, const std::string& value, std::vector<std::string>& out) {
  if (!shortcut.implied.empty()) out.push_back(shortcut.implied);
  out.push_back(shortcut.key + "=" + (shortcut.quoted ? quoted(value) : value));
}

/// The key and value of an assignment "key=value".
std::pair<std::string_view, std::string_view> parts_of(std::string_view assignment) {
  const std::size_t sign = assignment.find('=');
  return {assignment.substr(0, sign), assignment.substr(sign + 1)};
}

/// Why two of the given options cannot both hold: they assign different values to one key, such as
/// --camera, which implies device.kind="camera", and --device simulated.  Empty if they can.
std::string contradiction(const std::vector<Shortcut>& shortcuts,
                          const std::vector<std::optional<std::string>>& given) {
  std::map<std::string, std::pair<std::string, std::string>, std::less<>> chosen;
  for (std::size_t i = 0; i < shortcuts.size(); ++i) {
    if (!given[i]) continue;
    std::vector<std::string> assignments;
    assign(shortcuts[i], *given[i], assignments);
    for (const std::string& assignment : assignments) {
      const auto [key, value] = parts_of(assignment);
      const auto [before, is_new] =
          chosen.try_emplace(std::string(key), shortcuts[i].option, std::string(value));
      const auto& [option, other] = before->second;
      if (is_new || other == value) continue;
      return option + " sets " + before->first + " to " + other + ", " + shortcuts[i].option +
             " to " + std::string(value) + ": leave one of them out";
    }
  }
  return {};
}

}  // namespace

CommandLine read_command_line(const About& about, int argc, const char* const* argv) {
  CLI::App app{about.description, about.name};
  app.footer(footer(about));
  app.set_version_flag("--version", about.name + " " + std::string(version()));
  CommandLine out;
  std::vector<std::string> sets;
  app.add_option("--config", out.source.path, "JSON file with comments; absent: all defaults");
  app.add_option("--set", sets, "Overrides one key: PATH=VALUE; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--check", out.check_only,
               "Only says whether the configuration is good (exit code 0 or 2), and on standard "
               "error what would not work on this host now");
  const std::vector<Shortcut> shortcuts = shortcuts_of(about);
  std::vector<std::optional<std::string>> given(shortcuts.size());
  for (std::size_t i = 0; i < shortcuts.size(); ++i) {
    app.add_option(shortcuts[i].option, given[i], shortcuts[i].help);
  }
  if (const auto page = printed(app, {8, about.files}, argc, argv)) {
    std::fputs(page->c_str(), stdout);
    out.exit = kExitStopped;
    return out;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    out.exit = app.exit(error) == 0 ? kExitStopped : kExitMistaken;
    return out;
  }
  if (const std::string why = contradiction(shortcuts, given); !why.empty()) {
    std::fprintf(stderr, "%s: %s\n", about.name.c_str(), why.c_str());
    out.exit = kExitMistaken;
    return out;
  }
  for (std::size_t i = 0; i < shortcuts.size(); ++i) {
    if (given[i]) assign(shortcuts[i], *given[i], out.source.assignments);
  }
  out.source.assignments.insert(out.source.assignments.end(), sets.begin(), sets.end());
  return out;
}

}  // namespace chorus::service

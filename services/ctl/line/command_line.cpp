#include <algorithm>
#include <exception>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/nearest.h"
#include "common/base/version.h"
#include "common/service/manual.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

struct Added {
  CLI::App* options = nullptr;
  Run run;
};

/// Names the unknown or missing command; CLI11 would only say that an argument was not expected.
bool complain_of_unknown_command(std::span<const Command> commands, int argc,
                                 const char* const* argv) {
  std::vector<std::string> known;
  for (const Command& command : commands) known.emplace_back(command.name);
  if (argc < 2) {
    std::cerr << fmt::format("chorus: which command? They are: {}.\n", fmt::join(known, ", "))
              << "chorus help COMMAND explains each with examples.\n";
    return true;
  }
  if (argv[1][0] == '-') return false;
  const std::string word = argv[1];
  if (std::find(known.begin(), known.end(), word) != known.end()) return false;
  const std::string meant = nearest(word, known);
  std::cerr << fmt::format("chorus: there is no command \"{}\"{}\nThe commands are: {}.\n", word,
                           meant.empty() ? "." : fmt::format("; did you mean \"{}\"?", meant),
                           fmt::join(known, ", "));
  return true;
}

/// The words of the command line, where `help NAME` has become `NAME --help`.
std::vector<const char*> words_of(int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (argc < 2 || std::string_view(argv[1]) != "help") return words;
  words.erase(words.begin() + 1);
  words.push_back("--help");
  return words;
}

/// "chorus calibrate place": the name with those of the parsed commands below it.
std::string name_with_parts(const CLI::App* app) {
  std::string name = app->get_name();
  for (auto chosen = app->get_subcommands(); !chosen.empty();
       chosen = chosen.front()->get_subcommands())
    name += " " + chosen.front()->get_name();
  return name;
}

/// What is wrong with the words, and whose help explains them.
std::string usage_advice(const CLI::App* app, const CLI::Error& wrong) {
  const std::string name = name_with_parts(app);
  return fmt::format("{}: {}\n{} --help shows what it takes.\n", name, printable(wrong.what()),
                     name);
}

int run_added(const std::vector<Added>& all) {
  for (const Added& each : all) {
    if (!each.options->parsed()) continue;
    const Result<int> code = each.run();
    if (code) return *code;
    std::cerr << fmt::format("chorus {}: {}\n", name_with_parts(each.options),
                             printable(to_string(code.error())));
    return kExitFailed;
  }
  return kExitUsage;
}

int parse_and_run(std::span<const Command> commands, int argc, const char* const* argv) {
  CLI::App app{"Chorus: many body-tracking sensors, one tracker."};
  app.name("chorus");
  app.set_version_flag("--version", "chorus " + std::string(version()));
  app.require_subcommand(1);
  app.failure_message(&usage_advice);
  app.footer(
      "chorus help COMMAND explains each with examples.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage.");
  std::vector<Added> all;
  for (const Command& command : commands) {
    auto* options = app.add_subcommand(std::string(command.name), std::string(command.summary));
    options->footer(std::string(command.examples));
    all.push_back({options, command.add(*options)});
  }
  if (const auto page = service::printed(app, {}, argc, argv)) {
    std::cout << *page;
    return kExitOk;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return app.exit(wrong) == 0 ? kExitOk : kExitUsage;
  }
  return run_added(all);
}

}  // namespace

int run_command_line(std::span<const Command> commands, int argc, const char* const* argv) {
  const std::vector<const char*> words = words_of(argc, argv);
  const int count = static_cast<int>(words.size());
  if (complain_of_unknown_command(commands, count, words.data())) return kExitUsage;
  try {
    return parse_and_run(commands, count, words.data());
  } catch (const std::exception& unforeseen) {
    std::cerr << "chorus: " << unforeseen.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace chorus::ctl

// chorus-bench: measures every number that the project claims, one subcommand per claim.
#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "common/base/version.h"
#include "tests/bench/project_folder.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {
#define CHORUS_BENCH_CASE(name, summary) Result<void> run_##name(Report&);
#include "bench_cases.inc"
#undef CHORUS_BENCH_CASE
}  // namespace chorus::bench

namespace {

using chorus::Result;
using chorus::bench::Report;

struct Subcommand {
  const char* name;
  const char* summary;
  Result<void> (*run)(Report&);
};

constexpr Subcommand kSubcommands[] = {
#define CHORUS_BENCH_CASE(name, summary) {#name, summary, chorus::bench::run_##name},
#include "bench_cases.inc"
#undef CHORUS_BENCH_CASE
    {nullptr, nullptr, nullptr}};

constexpr int kConditionBroken = 1;
constexpr int kFailed = 2;

int run(const Subcommand& chosen, chorus::bench::Options options, const std::string& json_path) {
  options.name = chosen.name;
  Report report(options);
  if (const Result<void> done = chosen.run(report); !done) {
    std::cerr << "chorus-bench " << chosen.name << ": " << to_string(done.error()) << '\n';
    return kFailed;
  }
  if (!report.list()) report.print(std::cout);
  if (!json_path.empty()) {
    std::ofstream file(json_path);
    file << report.json();
    if (!file.flush()) {
      std::cerr << "chorus-bench: cannot write " << json_path << '\n';
      return kFailed;
    }
  }
  return report.all_conditions_hold() ? 0 : kConditionBroken;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Measures what Chorus claims and prints one table.  Exit code 0: measured, 1: a stated "
      "condition does not hold, 2: could not measure."};
  app.set_version_flag("--version", "chorus-bench " + std::string(chorus::version()));
  chorus::bench::Options options;
  std::string json_path;
  app.add_option("--json", json_path, "Also write the rows to this file as JSON");
  app.add_option("--seed", options.seed, "First random seed; runs use it and the ones after it")
      ->capture_default_str();
  app.add_option("--plots", options.plots, "Also draw charts (SVG) into this folder");
  app.add_flag("--quick", options.quick, "Fewer runs: a smoke test, indicative numbers only");
  app.require_subcommand(1);
  app.fallthrough();
  const Subcommand* chosen = nullptr;
  for (const Subcommand& each : kSubcommands) {
    if (each.name == nullptr) continue;
    auto* command = app.add_subcommand(each.name, each.summary);
    command->callback([&chosen, &each] { chosen = &each; });
    const std::string_view name = each.name;
    if (name != "faults" && name != "fusion" && name != "persons" && name != "camera" &&
        name != "registration" && name != "scale" && name != "inertial" && name != "ergonomics" &&
        name != "positioner" && name != "hand" && name != "site" && name != "report")
      continue;
    command->add_option("--only", options.only, "Run this case alone");
    command->add_flag("--list", options.list, "Name the cases and run none");
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kFailed;  // --help is not an error
  }
  // What the user wrote is relative to where the user is.
  for (std::string* path : {&json_path, &options.plots}) {
    if (!path->empty()) *path = std::filesystem::absolute(*path).string();
  }
  chorus::bench::enter_project_folder();
  return chosen == nullptr ? kFailed : run(*chosen, options, json_path);
}

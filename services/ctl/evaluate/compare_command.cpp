// chorus compare A B: two recordings of one motion, joint by joint.
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/comparison/comparison_report.h"
#include "common/report/report_files.h"
#include "services/ctl/evaluate/compared_source.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"

namespace chorus::ctl {
namespace {

struct CompareArguments {
  std::string a;
  std::string b;
  std::vector<std::string> out;
  double seconds = 30.0;
  double block = 5.0;
  double least_mm = 1.0;
  bool same_clock = false;
  bool any_lag = false;
  bool same_world = false;
  bool other_world = false;
};

Result<int> run_compare(const CompareArguments& arguments) {
  for (const std::string& file : arguments.out)
    if (auto ok = report::may_write_report(file); !ok) return pass(ok);
  auto a = read_compared(arguments.a, arguments.seconds);
  if (!a) return pass(a);
  auto b = read_compared(arguments.b, arguments.seconds);
  if (!b) return pass(b);
  comparison::CompareOptions options;
  options.same_clock = arguments.same_clock;
  options.same_world = arguments.same_world;
  options.other_world = arguments.other_world;
  options.block = arguments.block;
  options.least = 1e-3 * arguments.least_mm;
  if (arguments.any_lag) options.clock_range = std::nullopt;
  const auto compared = comparison::compare(a->people, b->people, options);
  if (!compared) return pass(compared);
  comparison::Compared what{arguments.a, arguments.b, a->notes};
  what.notes.insert(what.notes.end(), b->notes.begin(), b->notes.end());
  const report::Report report = comparison::report_of(*compared, what);
  for (const std::string& file : arguments.out) {
    const auto written = report::write_report(report, file);
    if (!written) return pass(written);
    std::cerr << "wrote " << file << '\n';
  }
  for (const std::string& note : what.notes) std::cerr << "note: " << printable(note) << '\n';
  std::cout << printable(report.verdict) << '\n';
  for (const std::string& difference : compared->differences)
    std::cout << printable("- " + difference) << '\n';
  return compared->differences.empty() ? kExitOk : kExitFailed;
}

}  // namespace

Run add_compare(CLI::App& options) {
  auto arguments = std::make_shared<CompareArguments>();
  constexpr const char* kSources =
      "fused frames (.mcap, a folder, NDJSON, a fusion server's address), or C3D, TRC, BVH, MVNX";
  options.add_option("a", arguments->a, kSources)->required();
  options.add_option("b", arguments->b, "the same, compared with a")->required();
  options.add_option("--out", arguments->out,
                     "write the report: .html, .json or .csv; repeat for several");
  auto* same_clock =
      options.add_flag("--same-clock", arguments->same_clock,
                       "both have one clock: no lag is looked for (two fusions of one recording)");
  options
      .add_flag("--any-lag", arguments->any_lag,
                "the clocks have nothing in common, as with files that state no UTC; the lag is no "
                "difference then")
      ->excludes(same_clock);
  auto* same_world = options.add_flag("--same-world", arguments->same_world,
                                      "both have one world: no transform is fitted");
  options
      .add_flag("--other-world", arguments->other_world,
                "the worlds have nothing in common; the transform is no difference then")
      ->excludes(same_world);
  options.add_option("--block", arguments->block, "length of the blocks of the intervals [s]")
      ->check(number_range(0.2, 60.0));
  options.add_option("--least", arguments->least_mm, "smallest difference that counts [mm]")
      ->check(number_range(0.0, 1000.0));
  options.add_option("--seconds", arguments->seconds, "how long to listen to a server")
      ->check(number_range(1.0, 3600.0));
  add_authority_option(options);
  add_token_footer(options);
  return [arguments] { return run_compare(*arguments); };
}

}  // namespace chorus::ctl

// Runs a small tracker of real processes and causes, case by case, what goes wrong in a workshop;
// checks what must hold in each case.
#include <algorithm>
#include <chrono>
#include <iostream>

#include <fmt/format.h>

#include "tests/bench/faults/trial.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {
namespace {

FaultCases all_cases() {
  FaultCases all;
  for (const auto& part :
       {sensor_cases(), inertial_cases(), lie_cases(), link_cases(), client_cases(), output_cases(),
        access_cases(), server_cases(), trust_cases(), stranger_cases()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

Trial run_one(const FaultCase& asked) {
  Trial trial;
  if (const auto done = asked.run(trial); !done) trial.check(false, to_string(done.error()));
  return trial;
}

bool holds(const Trial& trial) {
  return std::ranges::all_of(trial.checks, [](const Trial::Check& each) { return each.holds; });
}

void report_trial(Report& report, const FaultCase& asked, const Trial& trial) {
  const std::string name(asked.name);
  if (!trial.left_out.empty()) return report.note("LEFT OUT: " + name + ": " + trial.left_out);
  const bool survived = holds(trial);
  report.row(name, "survived", survived ? 1.0 : 0.0, "");
  const auto row = [&](const char* metric, double value, const char* unit) {
    if (!std::isnan(value)) report.row(name, metric, value, unit);
  };
  row("lost", trial.lost, "frames");
  row("recover_s", trial.recover_s, "s");
  row("rss_mb", trial.rss_mb, "MB");
  row("output_hz", trial.output_hz, "Hz");
  row("others_percent", trial.others_percent, "%");
  row("age_p90_ms", trial.age_p90_ms, "ms");
  if (survived) return report.condition(name, true);
  for (const Trial::Check& each : trial.checks) {
    if (!each.holds) report.condition(name + ": " + each.sentence, false);
  }
}

void run_and_tell(Report& report, const FaultCase& asked) {
  const auto begun = std::chrono::steady_clock::now();
  const Trial trial = run_one(asked);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  report_trial(report, asked, trial);
  const char* outcome = !trial.left_out.empty() ? "left out" : holds(trial) ? "survived" : "BROKEN";
  std::cerr << fmt::format("{:<24} {:<8} {:5.1f} s  {}\n", asked.name, outcome, took.count(),
                           asked.summary);
  for (const Trial::Check& each : trial.checks) {
    if (!each.holds) std::cerr << "    " << each.sentence << '\n';
  }
}

}  // namespace

Result<void> run_faults(Report& report) {
  const FaultCases all = all_cases();
  if (report.list()) {
    for (const FaultCase& each : all)
      std::cout << fmt::format("{:<24} {}{}\n", each.name, each.summary,
                               each.quick ? " (quick)" : "");
    return {};
  }
  const auto chosen = [&](const FaultCase& each) {
    return report.only().empty() ? !report.quick() || each.quick : each.name == report.only();
  };
  if (std::ranges::none_of(all, chosen))
    return fail(ErrorCode::InvalidArgument, "--only",
                "there is no case \"" + report.only() + "\"; --list shows all");
  for (const FaultCase& each : all) {
    if (chosen(each)) run_and_tell(report, each);
  }
  report.note(
      "survived: everything the case asks for holds.  lost: fused instants without a frame, or "
      "whose frame has no body.  recover_s: from the end of the fault until every sensor "
      "contributes again.  rss_mb: of chorus-fusion at the end.  others_percent: the least share "
      "of the frames that a sensor without fault contributed to.");
  return {};
}

}  // namespace chorus::bench

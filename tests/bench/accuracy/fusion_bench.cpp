// Compares fused joints with single sensors and all other methods, on the same frames and views.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "tests/bench/accuracy/fusion_cases.h"
#include "tests/bench/accuracy/fusion_cost.h"
#include "tests/bench/accuracy/fusion_motions.h"
#include "tests/bench/accuracy/fusion_prediction.h"
#include "tests/bench/accuracy/fusion_report.h"
#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/contest.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/methods/stress.h"
#include "tests/bench/report/report.h"
#include "tests/judge/cold_start.h"

namespace chorus::bench {
namespace {

using synthetic::PathKind;

constexpr Duration kSweepLength = std::chrono::seconds(5);
constexpr std::size_t kQuickDraws = 2;
constexpr Duration kQuickLength =
    std::chrono::seconds(10);  // the shortest walk from which sensors are registered

Draws draw_all(const Report& report, const FusionCase& each,
               const std::vector<Contender>& contenders) {
  const std::size_t count = report.quick() ? kQuickDraws : each.draws;
  return over_draws(count, [&](std::size_t draw) {
    Contest one = each.contest;
    one.setting.seed = report.seed() + draw;
    if (report.quick()) one.setting.length = std::min(one.setting.length, kQuickLength);
    if (each.cold) begin_cold(one.setting, draw);
    return hold(one, contenders);
  });
}

/// Reports one row for each way in which the person begins.
void report_cold_starts(Report& report, const std::string& name, const Draws& draws) {
  for (std::size_t kind = 0; kind < kColdStarts.size(); ++kind) {
    Draws own;
    for (std::size_t i = kind; i < draws.size(); i += kColdStarts.size()) own.push_back(draws[i]);
    if (own.empty()) continue;
    const std::string with = fmt::format("{}-{}", name, kColdStarts[kind]);
    for (std::size_t metric = 0; metric < metrics().size(); ++metric) {
      if (is_short_metric(metrics()[metric])) compare(with, own, metric).report(report);
    }
  }
}

Comparison measure(Report& report, const FusionCase& each) {
  const Draws draws = draw_all(report, each, all_contenders());
  if (each.cold) report_cold_starts(report, each.name, draws);
  return report_draws(report, each.name, draws, each.in_full);
}

/// The body filter without one of its parts.
Contender without(const char* part, void (*leave_out)(fusion::FusionConfig&)) {
  fusion::FusionConfig config;
  config.method = fusion::Method::BodyFilter;
  leave_out(config);
  return ours(config, std::string("without-") + part);
}

/// What each part of the body filter, and the consensus about sides, contributes: `ours` has all,
/// every other row leaves one out.
void ablate(Report& report) {
  using fusion::FusionConfig;
  FusionConfig whole;
  whole.method = fusion::Method::BodyFilter;
  const std::vector<Contender> contenders{
      ours(whole),
      without("turn", [](FusionConfig& c) { c.body.turn = 0; }),
      without("scale", [](FusionConfig& c) { c.body.scale = 0; }),
      without("bones", [](FusionConfig& c) { c.body.bone = 0; }),
      without("bias", [](FusionConfig& c) { c.body.bias_rate = 0; }),
      without("time", [](FusionConfig& c) { c.body.resting = 0; }),
      without("robust-loss", [](FusionConfig& c) { c.body.huber = 0; })};
  for (const char* profile : {"A", "B", "C", "D"}) {
    FusionCase each{fmt::format("ablation-workshop6-{}", profile),
                    contest_of(profile, 6, PathKind::Random)};
    each.contest.every_method = false;
    Draws draws = draw_all(report, each, contenders);
    each.contest.pipeline.sides.resolve = false;
    const Draws unresolved = draw_all(report, each, {ours(whole, "without-side-consensus")});
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i].push_back(unresolved[i].front());
    compare(each.name, draws, 0).report(report);
  }
}

/// Scales each source of error in turn, down and up.
void sweep(Report& report) {
  std::vector<Contender> contenders;
  for (Contender& each : all_contenders()) {
    const bool kept = each.name == "ours" || each.name == "otto" ||
                      each.name == "flip-fixed-mean" || each.name == "best-skeleton";
    if (kept) contenders.push_back(std::move(each));
  }
  for (const NamedSource& source : kSources) {
    for (const double factor : kFactors) {
      FusionCase each{fmt::format("sweep-{}-x{}", source.name, factor),
                      contest_of("A", 6, PathKind::Random)};
      each.contest.every_method = false;
      each.contest.setting.stress = {{source.source, factor}};
      each.contest.setting.length = kSweepLength;
      compare(each.name, draw_all(report, each, contenders), 0).report(report);
    }
  }
}

/// With white noise only, and registered from the same walk, fusion must be better than the best
/// single sensor in every draw.
void measure_gauss(Report& report) {
  FusionCase gauss{"workshop6-gauss", contest_of("gauss", 6, PathKind::Random)};
  gauss.contest.own_registration = true;
  const Comparison found = measure(report, gauss);
  report.condition(
      "workshop6-gauss: the fused mean joint error is below the best single sensor's in every draw",
      found.won_percent("best-sensor") == 100.0);
}

std::vector<FusionCase> all_cases() {
  std::vector<FusionCase> cases = main_cases();
  for (FusionCase& each : flip_cases()) cases.push_back(std::move(each));
  return cases;
}

/// Fails on a gross regression, before anybody reads the table.
void hold_to_ceiling(Report& report, const Comparison& found) {
  constexpr double kCeiling = 60.0;  // [mm] about twice the present error
  report.condition(fmt::format("{}: our mean joint error is below {} mm", kMainCase, kCeiling),
                   found.spread_of(kOurs).median < kCeiling);
}

/// True if the case with this name is to be run; `quick`: it is part of the smoke run.
bool is_chosen(const Report& report, const std::string& name, bool quick) {
  return report.only().empty() ? !report.quick() || quick : name == report.only();
}

/// Runs the chosen cases; false if there are none.
bool run_chosen(Report& report) {
  bool any = false;
  for (const FusionCase& each : all_cases()) {
    if (!is_chosen(report, each.name, each.quick)) continue;
    any = true;
    const Comparison errors = measure(report, each);
    if (each.name == kMainCase) hold_to_ceiling(report, errors);
  }
  for (const PredictionCase& each : prediction_cases()) {
    if (!is_chosen(report, each.name, false)) continue;
    any = true;
    measure_prediction(report, each);
  }
  for (const std::string& name : motion_cases()) {
    if (!is_chosen(report, name, false)) continue;
    any = true;
    measure_motions(report, name);
  }
  return any;
}

void list_cases() {
  for (const FusionCase& each : all_cases()) std::cout << each.name << '\n';
  for (const PredictionCase& each : prediction_cases()) std::cout << each.name << '\n';
  for (const std::string& name : motion_cases()) std::cout << name << '\n';
  for (const std::string& name : cost_cases()) std::cout << name << '\n';
}

void explain(Report& report) {
  report.note(
      "Medians over draws; every method gets the same views: same alignment, registration, facing "
      "and association.  True registration unless the case says otherwise.");
  report.note(
      "bound: per joint and instant the best linear combination of the views, given the true mean "
      "square of each sighting's error and true labels; not known for C and gauss.  "
      "oracle-weights: "
      "weights 1 / e^2 with each sighting's true error e.");
  report.note(
      "best-sensor: one sensor for the whole draw, chosen knowing the truth.  ours-true-labels: "
      "ours, if somebody told it which views have left and right exchanged.  arrival-kalman: held "
      "against the truth at the time it states, that of arrival.");
  report.note(
      "nees per axis, ball95 and sharpness (stated over true rms) are of stated covariances: 1, 95 "
      "% "
      "and 1 are honest, neither lower nor higher is better.  mpjpe_common_mm: over the joints "
      "that "
      "every method answers.  hold50_mm: the truth 50 ms later.  -cold: draws take turns in "
      "standing, "
      "waving, walking backwards and coming in from behind the sensors.");
  report.note("Simulated sensors.");
}

}  // namespace

Result<void> run_fusion(Report& report) {
  report.profile(described({"A", "B", "C", "D", "gauss"}));
  if (report.list()) {
    list_cases();
    return {};
  }
  if (std::ranges::count(cost_cases(), report.only()) > 0) return measure_cost(report);
  if (report.only().empty()) measure_gauss(report);
  if (!run_chosen(report)) {
    return fail(ErrorCode::InvalidArgument, "--only",
                "there is no case \"" + report.only() + "\"; --list shows all");
  }
  if (!report.only().empty()) return {};
  if (!report.quick()) {
    ablate(report);
    sweep(report);
  }
  if (auto done = measure_cost(report); !done) return done;
  explain(report);
  return {};
}

}  // namespace chorus::bench

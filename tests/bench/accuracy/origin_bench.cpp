// chorus-bench origin: whether a marked point stays where people put it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "tests/bench/accuracy/origin_life.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/report/report.h"
#include "tests/judge/judge.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kOriginDraws = 20;
constexpr std::size_t kQuickOriginDraws = 1;
constexpr std::size_t kQuickAgain = 2;
constexpr double kStays = mm(10);
constexpr double kStaysTurned = deg(0.1);

struct Stage {
  const char* name;
  std::vector<Drift> Life::*drifts;
};
constexpr Stage kStages[] = {{"again", &Life::again},     {"other-master", &Life::other_master},
                             {"restart", &Life::restart}, {"removed", &Life::removed},
                             {"added", &Life::added},     {"pushed", &Life::pushed}};

using Value = double Drift::*;

/// The largest value of each life, over all steps of the stage.
std::vector<double> largest(const std::vector<Life>& lives, const Stage& stage, Value value,
                            double scale) {
  std::vector<double> all;
  for (const Life& life : lives) {
    if ((life.*stage.drifts).empty()) continue;
    double most = 0.0;
    for (const Drift& drift : life.*stage.drifts) most = std::max(most, drift.*value);
    all.push_back(scale * most);
  }
  return all;
}

void add_row(Report& report, const std::string& name, const char* metric, const char* unit,
             std::vector<double> values) {
  Row row;
  row.case_name = name;
  row.metric = metric;
  row.unit = unit;
  row.value = median(values);
  row.spread =
      Spread{row.value, percentile(values, 0.05), percentile(values, 1.0), 0, values.size()};
  report.row(std::move(row));
}

void report_stage(Report& report, const std::string& profile, const std::vector<Life>& lives,
                  const Stage& stage) {
  const std::string name = fmt::format("{}-{}", stage.name, profile);
  const double per_metre = to_mm(1.0);
  const double per_radian = to_deg(1.0);
  add_row(report, name, "mark_mm", "mm", largest(lives, stage, &Drift::horizontal, per_metre));
  add_row(report, name, "mark_yaw_deg", "deg", largest(lives, stage, &Drift::yaw, per_radian));
  add_row(report, name, "corner_mm", "mm", largest(lives, stage, &Drift::corner, per_metre));
  add_row(report, name, "waist_mm", "mm", largest(lives, stage, &Drift::waist, per_metre));
  add_row(report, name, "height_mm", "mm", largest(lives, stage, &Drift::vertical, per_metre));
}

bool stays(const Life& life, const Stage& stage) {
  return !(life.*stage.drifts).empty() &&
         std::ranges::all_of(life.*stage.drifts, [](const Drift& drift) {
           return drift.horizontal <= kStays && drift.yaw <= kStaysTurned;
         });
}

void report_profile(Report& report, const std::string& profile, const std::vector<Life>& lives) {
  double refused = 0.0;
  double held = 0.0;
  for (const Life& life : lives) {
    refused += static_cast<double>(life.refused);
    held = std::max(held, life.held_shift);
  }
  for (const Stage& stage : kStages) {
    report_stage(report, profile, lives, stage);
    const auto within =
        std::ranges::count_if(lives, [&](const Life& l) { return stays(l, stage); });
    report.row(fmt::format("{}-{}", stage.name, profile), "within_percent",
               100.0 * static_cast<double>(within) / static_cast<double>(lives.size()), "%");
  }
  report.row("lives-" + profile, "walks_refused", refused, "");
  report.row("lives-" + profile, "held_shift_mm", to_mm(held), "mm");
  report.condition("held sensors do not move while one is added, profile " + profile, held == 0.0);
}

}  // namespace

Result<void> run_origin(Report& report) {
  report.profile(described({"A", "B"}));
  for (const std::string profile : {"A", "B"}) {
    const auto lives =
        over_draws(report.quick() ? kQuickOriginDraws : kOriginDraws, [&](std::size_t i) {
          LifeSetting setting;
          setting.profile = profile;
          setting.seed = report.seed() + i;
          if (report.quick()) setting.again = kQuickAgain;
          return live_on(setting);
        });
    report_profile(report, profile, lives);
  }
  report.note(
      "Simulated: one cell of six sensors (a seventh is added) per draw, the fusion server's core, "
      "a new person with new errors for every walk of 30 s.  The origin is set once, in the middle "
      "of the workspace.  mark_mm, mark_yaw_deg: how far the mark and its direction have gone from "
      "where they were then, the largest of all steps of the stage; spread: 5 % of the draws, and "
      "the worst.  corner_mm: the worst of four marks 1.4 m away; "
      "waist_mm: a point 1 m above the mark.  within_percent: draws in which "
      "mark and direction stay within 10 mm and 0.1 deg in all steps.");
  return {};
}

}  // namespace chorus::bench

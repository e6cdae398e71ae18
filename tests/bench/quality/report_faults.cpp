// What the verdict names of planted faults, and what it says of healthy recordings.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/bench/methods/over_draws.h"
#include "tests/bench/quality/planted_faults.h"
#include "tests/bench/quality/report_cases.h"
#include "tests/judge/crowd.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kQuickFaults = 2;

DaySetting day_of(const std::string& profile, std::uint64_t seed) {
  DaySetting setting;
  setting.work.profile = profile;
  setting.work.seed = seed;
  setting.work.length = std::chrono::seconds(30);
  return setting;
}

bool names(const quality::Finding& finding, const std::vector<std::string>& words) {
  return std::ranges::all_of(
      words, [&](const std::string& word) { return finding.what.find(word) != std::string::npos; });
}

struct Outcome {
  bool named = false;      ///< By a finding that the verdict shows.
  std::size_t others = 0;  ///< Findings beside it.
  std::string verdict;
};

Result<Outcome> outcome_of(const DaySetting& setting, const std::vector<std::string>& words) {
  const auto day = simulated_day(setting);
  if (!day) return pass(day);
  const quality::RecordingQuality found = judged(*day);
  const auto findings = quality::findings_of(found);
  Outcome out;
  const std::size_t shown = std::min(findings.size(), quality::kMostInVerdict);
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const bool named = !words.empty() && names(findings[i], words);
    out.named = out.named || (named && i < shown);
    if (!named) ++out.others;
  }
  out.verdict = quality::report_of(found).verdict;
  return out;
}

/// Healthy recordings: one person and two, at work and walking, three kinds of sensors.
DaySetting healthy_day(std::size_t number, std::uint64_t seed) {
  constexpr std::array kProfiles{"A", "B", "D", "A"};
  DaySetting setting = day_of(kProfiles[number % kProfiles.size()], seed + number);
  if (number % 4 == 3) setting.work.people = people_at_work(2, seed + number);
  if (number % 5 == 4) setting.work.walk = synthetic::PathKind::Assembly;
  return setting;
}

}  // namespace

Result<void> report_faults(Report& report) {
  auto faults = planted_faults();
  if (report.quick()) faults.resize(kQuickFaults);
  const auto planted = over_draws(faults.size(), [&](std::size_t i) {
    DaySetting setting = day_of(i % 3 == 2 ? "D" : "A", report.seed() + 100 + i);
    faults[i].plant(setting);
    return outcome_of(setting, faults[i].named_by);
  });
  std::size_t named = 0;
  std::size_t others = 0;
  for (std::size_t i = 0; i < planted.size(); ++i) {
    if (!planted[i]) return pass(planted[i]);
    named += planted[i]->named ? 1U : 0U;
    others += planted[i]->others;
    report.row("fault-" + faults[i].name, "named", planted[i]->named ? 1.0 : 0.0, "");
    report.note(fmt::format("{}: {}: {}", faults[i].name, planted[i]->named ? "named" : "MISSED",
                            planted[i]->verdict));
  }
  const std::size_t healthy = report.quick() ? 1 : 20;
  const auto clean = over_draws(
      healthy, [&](std::size_t i) { return outcome_of(healthy_day(i, report.seed() + 200), {}); });
  std::size_t blamed = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (!clean[i]) return pass(clean[i]);
    if (clean[i]->others == 0) continue;
    ++blamed;
    report.note(fmt::format("healthy {}: BLAMED: {}", i, clean[i]->verdict));
  }
  report.row("faults", "named", static_cast<double>(named), fmt::format("of {}", faults.size()));
  report.row("faults", "other_findings", static_cast<double>(others), "");
  report.row("faults", "healthy_blamed", static_cast<double>(blamed),
             fmt::format("of {}", healthy));
  report.condition(
      fmt::format("faults: at least 90 % of planted faults are named in the verdict ({} of {})",
                  named, faults.size()),
      10 * named >= 9 * faults.size());
  report.condition(
      fmt::format("faults: at most one in twenty healthy recordings is blamed ({} of {})", blamed,
                  healthy),
      20 * blamed <= healthy);
  return {};
}

}  // namespace chorus::bench

// Identities: our association compared with assignment to the nearest neighbour and with the
// sensors' own ids; with single sources of error scaled up and down, and with parts of the
// association left out.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>

#include "tests/bench/accuracy/persons_cases.h"
#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/methods/stress.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kQuickDraws = 2;
constexpr Duration kQuickLength = std::chrono::seconds(4);
constexpr Duration kSweepLength = std::chrono::seconds(12);
constexpr double kPercent = 100.0;

struct Figure {
  const char* name;
  const char* unit;
  double (*of)(const Identity&);
  Better better = Better::Lower;
};
constexpr std::array kFigures{
    Figure{"idf1", "%", [](const Identity& i) { return kPercent * i.idf1; }, Better::Higher},
    Figure{"switches_per_minute", "1/min",
           [](const Identity& i) { return static_cast<double>(i.switches) / i.minutes; }},
    Figure{"fragmentations_per_minute", "1/min",
           [](const Identity& i) { return static_cast<double>(i.fragmentations) / i.minutes; }},
    Figure{"ghosts_per_minute", "1/min",
           [](const Identity& i) { return static_cast<double>(i.ghosts) / i.minutes; }},
    Figure{"inherited_per_minute", "1/min",
           [](const Identity& i) { return static_cast<double>(i.inherited) / i.minutes; }},
    Figure{"spare_ids_per_minute", "1/min",
           [](const Identity& i) { return static_cast<double>(i.spare_ids) / i.minutes; }},
    Figure{"longest_false_s", "s", [](const Identity& i) { return i.longest_false; }},
    Figure{"longest_unseen_s", "s", [](const Identity& i) { return i.longest_unseen; }},
    Figure{"first_answer_s", "s", [](const Identity& i) { return i.first_answer; }},
    Figure{"missing_percent", "%",
           [](const Identity& i) { return kPercent * (1.0 - i.coverage); }}};

using Draws = std::vector<Identities>;

Draws draw_all(const Report& report, PersonsCase each, const std::vector<Association>& ours) {
  if (report.quick()) each.length = std::min(each.length, kQuickLength);
  return over_draws(report.quick() ? kQuickDraws : each.draws, [&](std::size_t draw) {
    return identities_in(each, report.seed() + draw, ours);
  });
}

/// Percentage of the draws in which no person's id ever changed.
double no_switch_percent(const Draws& draws, const std::string& method) {
  const auto faultless = std::ranges::count_if(
      draws, [&](const Identities& found) { return found.at(method).switches == 0; });
  return kPercent * static_cast<double>(faultless) / static_cast<double>(draws.size());
}

/// Ours unchanged, and variants that leave one part out.  Prediction and one-to-one assignment
/// cannot be switched off; nearest-neighbour, which lacks them, shows what they contribute.
std::vector<Association> ablations() {
  const associate::AssociationConfig whole;
  std::vector<Association> all{{kOurs, whole}};
  associate::AssociationConfig config = whole;
  config.coast = std::chrono::milliseconds(50);  // longer than one instant, shorter than two
  all.push_back({"without-coasting", config});
  config = whole;
  config.confirm_frames = 1;
  all.push_back({"without-confirmation", config});
  config = whole;
  config.merge_frames = std::numeric_limits<int>::max();
  all.push_back({"without-merging", config});
  config = whole;
  config.gate = 10.0;  // [m] reaches across the whole room
  all.push_back({"without-gate", config});
  config = whole;
  config.doubt = Duration{0};
  all.push_back({"without-waiting", config});
  config = whole;
  config.remember = Duration{0};
  all.push_back({"without-remembering", config});
  config = whole;
  config.carry = Duration{0};
  all.push_back({"without-carrying", config});
  return all;
}

/// Keeps ours and its ablations if `ablated`, otherwise ours and the other methods.
Draws only(const Draws& draws, bool ablated) {
  Draws kept = draws;
  for (Identities& identities : kept) {
    std::erase_if(identities, [&](const auto& each) {
      return each.first != kOurs && each.first.starts_with("without-") != ablated;
    });
  }
  return kept;
}

/// Reports one row for each method that ours is compared with.
void report_no_switch(Report& report, const std::string& name, const Draws& draws) {
  const double ours = no_switch_percent(draws, kOurs);
  for (const auto& [method, identity] : draws.front()) {
    if (method == kOurs) continue;
    report.row(name, "no_switch_percent", ours, "%", method,
               ours / no_switch_percent(draws, method));
  }
}

void report_figure(Report& report, const std::string& name, const Draws& draws,
                   const Figure& figure) {
  Comparison comparison(name, figure.name, figure.unit, figure.better);
  for (std::size_t draw = 0; draw < draws.size(); ++draw) {
    for (const auto& [method, identity] : draws[draw]) {
      comparison.add(method, draw, figure.of(identity));
    }
  }
  comparison.report(report);
  if (figure.better == Better::Higher) comparison.report_wins(report);
}

/// Reports our mean over the draws, because the median is often zero and then shows no difference.
void report_mean_ghosts(Report& report, const std::string& name, const Draws& draws) {
  double sum = 0.0;
  for (const Identities& found : draws)
    sum += static_cast<double>(found.at(kOurs).ghosts) / found.at(kOurs).minutes;
  report.row(name, "mean_ghosts_per_minute", sum / static_cast<double>(draws.size()), "1/min");
}

/// Reports the share of the draws in which nobody is published for more than a second who is not
/// there.
void report_short_ghosts(Report& report, const std::string& name, const Draws& draws) {
  const auto gone = std::ranges::count_if(
      draws, [](const Identities& found) { return found.at(kOurs).longest_false <= 1.0; });
  report.row(name, "false_within_1s_percent",
             kPercent * static_cast<double>(gone) / static_cast<double>(draws.size()), "%");
}

void report_sides(Report& report, PersonsCase each) {
  if (report.quick()) each.length = std::min(each.length, kQuickLength);
  const auto wrong = over_draws(report.quick() ? kQuickDraws : each.draws, [&](std::size_t draw) {
    return sides_wrong_in(each, report.seed() + draw);
  });
  Comparison comparison(each.name, "sides_wrong_percent", "%", Better::Lower);
  for (std::size_t draw = 0; draw < wrong.size(); ++draw)
    comparison.add(kOurs, draw, kPercent * wrong[draw]);
  comparison.report(report);
}

void report_draws(Report& report, const std::string& name, const Draws& draws) {
  report_no_switch(report, name, draws);
  report_mean_ghosts(report, name, draws);
  report_short_ghosts(report, name, draws);
  for (const Figure& figure : kFigures) report_figure(report, name, draws, figure);
}

constexpr std::array<std::string_view, 4> kAblated{"crossing-2-hidden", "crossing-2-B",
                                                   "crossing-2-C", "crossing-4"};

void measure(Report& report, const PersonsCase& each) {
  const bool ablated = std::ranges::find(kAblated, each.name) != kAblated.end();
  const Draws draws =
      draw_all(report, each, ablated ? ablations() : std::vector<Association>{{kOurs}});
  report_draws(report, each.name, only(draws, false));
  if (each.sides) report_sides(report, each);
  if (ablated) report_draws(report, "ablation-" + each.name, only(draws, true));
  if (each.name != kCrossingTwo) return;
  constexpr double kMin = 50.0;  // [%] generous: it detects a regression and is not a target
  report.condition(
      fmt::format("{}: in at least {} % of the draws no id changes", kCrossingTwo, kMin),
      no_switch_percent(draws, kOurs) >= kMin);
}

PersonsCase case_named(const std::string& name) {
  const auto cases = persons_cases();
  return *std::ranges::find(cases, name, &PersonsCase::name);
}

/// A source of error that can mislead association.
struct Part {
  const char* name;
  void (*scale)(synthetic::kinect::Profile&, double factor);
};
using synthetic::kinect::Profile;

double share(double value, double factor) { return std::clamp(value * factor, 0.0, 1.0); }

constexpr std::array kParts{
    Part{"id-swap", [](Profile& p, double f) { p.gross.id_swap = share(p.gross.id_swap, f); }},
    Part{"ghosts", [](Profile& p, double f) { p.gross.ghosts_per_minute *= f; }},
    Part{"merged-legs",
         [](Profile& p, double f) { p.gross.leg_merge = share(p.gross.leg_merge, f); }},
    Part{"gaps",
         [](Profile& p, double f) {
           p.delivery.gaps_per_minute *= f;
           p.delivery.drop_share = std::min(0.9, p.delivery.drop_share * f);
         }},
    // The girth scales the radii of the bodies that occlude others.
    Part{"occlusion", [](Profile& p, double f) { p.visibility.girth *= f; }},
    Part{"yaw", [](Profile& p, double f) { p = with_source(std::move(p), Yaw, f); }}};

/// Varies one source after the other in the scene that separates methods best; the unchanged
/// profile is common to all sources and is measured once.
void sweep(Report& report) {
  PersonsCase usual = case_named("crossing-2-hidden");
  usual.length = kSweepLength;
  const auto measure_as = [&](const std::string& what, const PersonsCase& each) {
    report_draws(report, "sweep-" + what, draw_all(report, each, {{kOurs}}));
  };
  measure_as("all-x1", usual);
  for (const Part& part : kParts) {
    for (const double factor : kFactors) {
      if (factor == 1.0) continue;
      PersonsCase each = usual;
      each.adjust = [&](Profile& profile, std::size_t place) {
        usual.adjust(profile, place);
        part.scale(profile, factor);
      };
      measure_as(fmt::format("{}-x{}", part.name, factor), each);
    }
  }
}

}  // namespace

Result<void> run_persons(Report& report) {
  report.profile(described({"A", "B", "C"}));
  const std::vector<PersonsCase> cases = persons_cases();
  if (report.list()) {
    for (const PersonsCase& each : cases) std::cout << each.name << '\n';
    return {};
  }
  const auto chosen = [&](const PersonsCase& each) {
    return report.only().empty() || each.name == report.only();
  };
  if (std::ranges::none_of(cases, chosen)) {
    return fail(ErrorCode::InvalidArgument, "--only",
                "there is no case \"" + report.only() + "\"; --list shows all");
  }
  for (const PersonsCase& each : cases) {
    if (chosen(each)) measure(report, each);
  }
  if (!report.quick() && report.only().empty()) sweep(report);
  report.note("Medians over draws; true registration; every method gets the same bodies.");
  report.note(
      "best-sensor-ids: one sensor's own ids at face value, the sensor chosen knowing the truth.  "
      "nearest-neighbour: greedy, without prediction, the same gate and confirmation as ours.  "
      "idf1: higher is better, so a ratio above 1 is ours being better.");
  report.note("Simulated sensors.");
  return {};
}

}  // namespace chorus::bench

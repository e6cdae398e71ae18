#include "tests/bench/accuracy/registration_cases.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "tests/bench/accuracy/exchange.h"
#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using synthetic::PathKind;

constexpr double kUnsynchronised = 0.5;  // [s]

/// A van, 2 m high, that moves to and fro between the person and two of the sensors.
synthetic::Occluder van() {
  synthetic::Occluder box;
  box.world_from_box.translation() = Eigen::Vector3d(-0.6, 1.0, 1.8);
  box.half = {0.8, 1.0, 0.3};
  box.travel = {1.2, 0, 0};
  box.period = std::chrono::seconds(20);
  return box;
}

Setting ring(const std::string& profile) {
  Setting setting;
  setting.profile = profile;
  return setting;
}

std::vector<SensorId> scored(const Workshop& workshop, bool last_only) {
  std::vector<SensorId> sensors;
  for (const registration::WalkTrack& track : workshop.tracks) sensors.push_back(track.sensor);
  if (last_only) sensors.erase(sensors.begin(), std::prev(sensors.end()));
  return sensors;
}

std::vector<RegistrationMethod> methods_of(const RegistrationCase& each) {
  std::vector<RegistrationMethod> methods = each.beside;
  methods.insert(methods.begin(), our_registration());
  return methods;
}

/// The scores of one draw, by length and then by method.
using DrawScores = std::vector<std::vector<Score>>;

DrawScores one_draw(const RegistrationCase& each, std::uint64_t seed) {
  Setting setting = each.setting;
  setting.seed = seed;
  setting.length =
      std::chrono::seconds(*std::max_element(each.lengths.begin(), each.lengths.end()));
  Workshop workshop = draw_workshop(setting);
  if (each.corrected) workshop.tracks = with_corrected_clocks(workshop, Network{});
  DrawScores scores;
  for (const int length : each.lengths) {
    const auto tracks = first_of(workshop, std::chrono::seconds(length));
    std::vector<Score> row;
    for (const RegistrationMethod& method : methods_of(each)) {
      const Registration solved =
          method.solve(tracks, workshop.begin, workshop.tracks.front().sensor);
      row.push_back(score_of(workshop, solved, scored(workshop, each.last_only)));
    }
    scores.push_back(std::move(row));
  }
  return scores;
}

template <class Count>
double percent_of(const std::vector<Score>& draws, Count count) {
  std::size_t counted = 0;
  std::size_t asked = 0;
  for (const Score& score : draws) {
    counted += count(score);
    asked += score.asked;
  }
  return asked == 0 ? kNoRatio : 100.0 * static_cast<double>(counted) / static_cast<double>(asked);
}

/// Percentage of the placed sensors that `count` counts.
template <class Count>
double percent_of_placed(const std::vector<Score>& draws, Count count) {
  std::size_t placed = 0;
  std::size_t counted = 0;
  for (const Score& score : draws) {
    placed += score.asked - score.refused;
    counted += count(score);
  }
  return placed == 0 ? kNoRatio
                     : 100.0 * static_cast<double>(counted) / static_cast<double>(placed);
}

/// Reports the horizontal errors that our method states, and how often they hold.
void report_stated(Report& report, const std::string& name, const std::vector<Score>& draws) {
  std::vector<double> stated;
  std::vector<double> off;
  for (const Score& score : draws) {
    stated.insert(stated.end(), score.stated.begin(), score.stated.end());
    off.insert(off.end(), score.off.begin(), score.off.end());
  }
  report.row(name, "ellipse95_cover_percent",
             percent_of_placed(draws, [](const Score& score) { return score.covered; }), "%");
  report.row(name, "radius95_cover_percent",
             percent_of_placed(draws, [](const Score& score) { return score.inside; }), "%");
  if (stated.empty()) return;
  const double radius = median(stated);
  report.row(name, "radius95_mm", to_mm(radius), "mm");
  report.row(name, "radius95_over_error", radius / median(off), "1");
}

/// Otto Table 1: position deviation [mm] of two sensors at this angle [deg].
struct PublishedPair {
  int angle;
  double deviation;
};
constexpr PublishedPair kTableOne[] = {{0, 9.6}, {45, 16.0}, {90, 17.8}, {135, 26.6}, {180, 12.3}};

std::vector<RegistrationCase> pairs(const std::string& profile) {
  std::vector<RegistrationCase> cases;
  for (const PublishedPair& published : kTableOne) {
    Setting pair = ring(profile);
    pair.places = pair_places(deg(published.angle));
    RegistrationCase each{
        fmt::format("pair-{{}}s-{}-{}", published.angle, profile), pair, {10}, all_baselines()};
    each.table1 = published.deviation;
    cases.push_back(std::move(each));
  }
  return cases;
}

/// Rings with other walks, an occluder, or clocks that are off.
std::vector<RegistrationCase> disturbed_rings(const std::string& profile) {
  std::vector<RegistrationCase> cases;
  for (const auto& [name, path] :
       {std::pair{"circle", PathKind::Circle}, {"line", PathKind::Line}}) {
    Setting walked = ring(profile);
    walked.walk = path;
    // The untimed ICP fails on both walks by a metre and takes most of the time, so it runs for
    // profile A only.
    cases.push_back({fmt::format("ring6-{}-{{}}s-{}", name, profile),
                     walked,
                     {30},
                     profile == "A" ? all_baselines() : timed_baselines()});
  }
  Setting hidden = ring(profile);
  hidden.occluders = {van()};
  cases.push_back({"ring6-occluder-{}s-" + profile, hidden, {30}, timed_baselines()});
  Setting off = ring(profile);
  off.clock_offset = kUnsynchronised;
  cases.push_back({"ring6-clock500ms-{}s-" + profile, off, {30}, timed_baselines(), true});
  cases.push_back({"ring6-clock500ms-uncorrected-{}s-" + profile, off, {30}, timed_baselines()});
  return cases;
}

struct PlaceMetric {
  const char* name;
  const char* unit;
  double (*value)(const Score&);
};
constexpr PlaceMetric kMetrics[] = {
    {"position_mm", "mm", [](const Score& s) { return to_mm(s.position); }},
    {"position_worst_mm", "mm", [](const Score& s) { return to_mm(s.position_worst); }},
    {"horizontal_mm", "mm", [](const Score& s) { return to_mm(s.horizontal); }},
    {"vertical_mm", "mm", [](const Score& s) { return to_mm(s.vertical); }},
    {"yaw_deg", "deg", [](const Score& s) { return to_deg(s.yaw); }},
    {"pitch_roll_deg", "deg", [](const Score& s) { return to_deg(s.pitch_roll); }},
    {"workspace_centre_mm", "mm", [](const Score& s) { return to_mm(s.centre); }},
};

}  // namespace

std::vector<RegistrationCase> registration_cases(const std::string& profile) {
  std::vector<RegistrationCase> cases = pairs(profile);
  const bool rendered = profile == "C";  // most of a draw's cost: use one walk for all lengths
  if (rendered) {
    cases.push_back({"ring6-{}s-" + profile, ring(profile), {30, 60}, timed_baselines()});
  } else {
    cases.push_back({"ring6-{}s-" + profile, ring(profile), {30}, all_baselines()});
    cases.push_back({"ring6-{}s-" + profile, ring(profile), {10, 60}, timed_baselines()});
    for (RegistrationCase& each : disturbed_rings(profile)) cases.push_back(std::move(each));
  }
  Setting row = row_of_four();
  row.profile = profile;
  const int along = rendered ? 30 : 60;  // [s]; the same path, there and back once
  cases.push_back({"line4-" + profile, row, {along}, timed_baselines(), false, true});
  return cases;
}

std::vector<std::vector<MethodScores>> run_case(const RegistrationCase& each,
                                                std::uint64_t first_seed) {
  const auto draws =
      over_draws(each.draws, [&](std::size_t i) { return one_draw(each, first_seed + i); });
  std::vector<MethodScores> none;
  for (const RegistrationMethod& method : methods_of(each)) none.push_back({method.name, {}});
  std::vector<std::vector<MethodScores>> by_length(each.lengths.size(), none);
  for (const DrawScores& draw : draws) {
    for (std::size_t length = 0; length < draw.size(); ++length) {
      for (std::size_t m = 0; m < draw[length].size(); ++m) {
        by_length[length][m].draws.push_back(draw[length][m]);
      }
    }
  }
  return by_length;
}

void report_case(Report& report, const std::string& name, const std::vector<MethodScores>& scores,
                 double table1) {
  for (const PlaceMetric& metric : kMetrics) {
    Comparison comparison(name, metric.name, metric.unit);
    for (const MethodScores& method : scores) {
      for (std::size_t i = 0; i < method.draws.size(); ++i) {
        comparison.add(method.name, i, metric.value(method.draws[i]));
      }
    }
    if (std::isfinite(table1) && &metric == &kMetrics[0]) {
      for (std::size_t i = 0; i < scores.front().draws.size(); ++i) {
        comparison.add("table1", i, table1);
      }
    }
    comparison.report(report);
  }
  for (const MethodScores& method : scores) {
    const std::string prefix = method.name == kOurs ? "" : method.name + "_";
    report.row(name, prefix + "over_100mm_percent", lost_percent(method.draws), "%");
    report.row(name, prefix + "refused_percent", refused_percent(method.draws), "%");
  }
  report_stated(report, name, scores.front().draws);
}

double lost_percent(const std::vector<Score>& draws) {
  return percent_of(draws, [](const Score& score) { return score.lost; });
}

double refused_percent(const std::vector<Score>& draws) {
  return percent_of(draws, [](const Score& score) { return score.refused; });
}

}  // namespace chorus::bench

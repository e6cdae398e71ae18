// hall-8x8: twelve people in eight cells, with gaps and walls.
#include <algorithm>
#include <array>
#include <limits>

#include "tests/bench/site/cascade.h"
#include "tests/bench/site/site_cases.h"
#include "tests/judge/hall_scenes.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr const char* kHallCase = "hall-8x8";
constexpr std::size_t kPeople = 12;
constexpr double kMinutes = 10.0;
constexpr double kQuickMinutes = 1.0;
constexpr int kEvery = 6;  // steps from one roll of everybody to the next: five a second

/// One method over the whole time.
struct Method {
  const char* name;
  Crossings crossings{Hall::kPeriod};
  std::vector<Roll> rolls = {};
};

/// Where everybody is whom a cell sees; the others are not in the hall.
std::vector<Eigen::Vector2d> whereabouts(const Hall& hall) {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> all(hall.people().size(), Eigen::Vector2d(kNowhere, kNowhere));
  for (const HallWord& word : hall.words())
    all[word.person] = *hall.people()[word.person].path(hall.time());
  return all;
}

void note(Method& method, const Hall& hall, HallAnswer answer, bool roll) {
  method.crossings.add(hall.time(), answer.seen);
  if (!roll) return;
  method.rolls.push_back(
      {hall.clock(0) - hall.cells()[0].clock_ahead, std::move(answer.people), whereabouts(hall)});
}

double percent(std::size_t part, std::size_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : kNoRatio;
}

struct Figures {
  double overlap = 0.0;
  double gap = 0.0;
  double wrong = 0.0;
  double unsaid = 0.0;
  double doubled = 0.0;
  double first_p95 = 0.0;
  double doubtful = 0.0;
  double idf1 = 0.0;
  std::size_t overlaps = 0;
  std::size_t gaps = 0;
};

Figures figures_of(Method& method) {
  const CrossingScore score = method.crossings.score();
  const std::size_t all = score.overlap.all + score.gap.all;
  Figures figures;
  figures.overlap = percent(score.overlap.kept, score.overlap.all);
  figures.gap = percent(score.gap.kept, score.gap.all);
  figures.wrong = percent(score.overlap.wrong + score.gap.wrong, all);
  figures.unsaid = percent(score.overlap.wrong_unsaid + score.gap.wrong_unsaid, all);
  figures.doubled = score.doubled_per_minute;
  figures.first_p95 = percentile(score.first_id, 0.95);
  figures.doubtful = score.doubtful_percent;
  figures.idf1 = 100.0 * identity_of(method.rolls).idf1;
  figures.overlaps = score.overlap.all;
  figures.gaps = score.gap.all;
  return figures;
}

struct HallRow {
  const char* metric;
  const char* unit;
  double Figures::*value;
};
constexpr std::array kHallRows{HallRow{"handover_percent", "%", &Figures::overlap},
                               HallRow{"handover_gap_percent", "%", &Figures::gap},
                               HallRow{"wrong_id_percent", "%", &Figures::wrong},
                               HallRow{"wrong_id_unsaid_percent", "%", &Figures::unsaid},
                               HallRow{"doubled_per_minute", "1/min", &Figures::doubled},
                               HallRow{"first_id_p95_s", "s", &Figures::first_p95},
                               HallRow{"doubtful_percent", "%", &Figures::doubtful},
                               HallRow{"idf1", "%", &Figures::idf1}};

void report_hall(Report& report, std::array<Method, 3>& methods) {
  const Figures ours = figures_of(methods[0]);
  report.row(kHallCase, "crossings_overlap", static_cast<double>(ours.overlaps), "");
  report.row(kHallCase, "crossings_gap", static_cast<double>(ours.gaps), "");
  for (std::size_t m = 1; m < methods.size(); ++m) {
    const Figures theirs = figures_of(methods[m]);
    for (const HallRow& row : kHallRows) {
      report.row(kHallCase, row.metric, ours.*row.value, row.unit, methods[m].name,
                 ours.*row.value / theirs.*row.value);
      report.row(kHallCase, std::string(methods[m].name) + "_" + row.metric, theirs.*row.value,
                 row.unit);
    }
  }
  if (report.quick()) return;
  report.condition("hall-8x8: hand-over with overlap >= 95 %", ours.overlap >= 95.0);
  report.condition("hall-8x8: hand-over across gaps >= 80 %", ours.gap >= 80.0);
  report.condition("hall-8x8: wrong ids <= 0.5 %", ours.wrong <= 0.5);
  report.condition("hall-8x8: doubled <= 0.5 a minute", ours.doubled <= 0.5);
  report.condition("hall-8x8: first id <= 0.6 s (95 %)", ours.first_p95 <= 0.6);
  report.condition("hall-8x8: doubt stated <= 5 % of the time", ours.doubtful <= 5.0);
  report.condition("hall-8x8: IDF1 >= 95", ours.idf1 >= 95.0);
}

}  // namespace

void run_hall_case(Report& report) {
  const double length = 60.0 * (report.quick() ? kQuickMinutes : kMinutes);
  Hall hall(eight_cells(report.seed()), people_in_hall(report.seed(), kPeople, length),
            report.seed());
  std::array<Method, 3> methods{Method{"site"}, Method{"cascade"}, Method{"cells-alone"}};
  OverSite over_site;
  Cascade cascade;
  for (int step = 1; hall.time() < length; ++step) {
    hall.step();
    const bool roll = step % kEvery == 0;
    note(methods[0], hall, over_site.at(hall), roll);
    note(methods[1], hall, cascade.at(hall), roll);
    note(methods[2], hall, cells_alone(hall), roll);
  }
  report_hall(report, methods);
}

}  // namespace chorus::bench

#include "tests/bench/accuracy/fusion_cost.h"

#include <time.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "common/base/units.h"
#include "tests/bench/live/live_cell.h"
#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/moments.h"
#include "tests/judge/crowd.h"
#include "tests/judge/judge.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr double kCostRate = 30.0;  // [Hz]
constexpr Duration kCostLength = std::chrono::seconds(10);
constexpr Duration kQuickLength = std::chrono::seconds(2);
constexpr double kLiveRun = 8.0;  // [s]
constexpr int kCostRuns = 3;

struct CostCase {
  const char* name;
  std::size_t sensors;
  std::size_t persons;
  double most_p99_ms;  ///< Limit of fuse_p99_ms, checked in full runs only.
};
constexpr std::array kCostCases{CostCase{"cost-10x6", 10, 6, 1.5},
                                CostCase{"scale-64x2", 64, 2, 5.0}};

Workshop workshop_of(const Report& report, const CostCase& each) {
  Setting setting;
  setting.seed = report.seed();
  synthetic::Ring ring;
  ring.count = each.sensors;
  setting.places = ring_places(ring);
  setting.people = people_at_work(each.persons, setting.seed);
  setting.length = report.quick() ? kQuickLength : kCostLength;
  return draw_workshop(setting);
}

/// Processor time that this thread has used [ms].  Other processes do not count.
double thread_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// The true places, with covariances as a walk leaves them, because these cost time, too.
Registration places_of(const Workshop& workshop) {
  constexpr double kTurn = 3e-3;  // [rad]
  constexpr double kPlace = mm(10);
  Registration places = true_registration(workshop, workshop.tracks.front().sensor);
  for (auto& [sensor, place] : places.sensors) {
    place.covariance.diagonal().head<3>().setConstant(kTurn * kTurn);
    place.covariance.diagonal().tail<3>().setConstant(kPlace * kPlace);
  }
  return places;
}

/// Processor time of every instant, from its frames to the snapshot [ms].
std::vector<double> step_times_once(const Workshop& workshop, fusion::Method method) {
  pipeline::PipelineConfig config;
  config.fusion.method = method;
  const Registration places = places_of(workshop);
  Arriving arriving(workshop.tracks);
  pipeline::Memory memory;
  std::vector<double> times;
  const Timestamp end = workshop.begin + workshop.setting.length;
  const Duration step = from_seconds(1.0 / kCostRate);
  for (Timestamp instant = workshop.begin; instant <= end; instant += step) {
    const pipeline::Histories& histories = arriving.until(instant);
    const Timestamp late = instant + config.align.patience + Duration(1);
    const double begun = thread_ms();
    auto done = pipeline::step({instant, late, times.size()}, histories, places, memory, config);
    times.push_back(thread_ms() - begun);
    memory = std::move(done.memory);
  }
  return times;
}

/// The least of several runs for each instant: every run does the same work, and other load can
/// only add to it.
std::vector<double> step_times(const Workshop& workshop, fusion::Method method) {
  std::vector<double> least = step_times_once(workshop, method);
  for (int run = 1; run < kCostRuns; ++run) {
    const std::vector<double> times = step_times_once(workshop, method);
    std::ranges::transform(least, times, least.begin(),
                           [](double a, double b) { return std::min(a, b); });
  }
  return least;
}

void report_times(Report& report, const CostCase& each) {
  const Workshop workshop = workshop_of(report, each);
  const auto ours = step_times(workshop, fusion::FusionConfig{}.method);
  const auto mean = step_times(workshop, fusion::Method::Mean);
  for (const auto& [metric, share] :
       {std::pair{"fuse_p50_ms", 0.5}, std::pair{"fuse_p99_ms", 0.99}}) {
    const double spent = percentile(ours, share);
    report.row(each.name, metric, spent, "ms", "flip-fixed-mean", spent / percentile(mean, share));
  }
  if (report.quick()) return;  // may be a build without optimisation, whose times mean nothing
  report.condition(
      fmt::format("{}: one instant is fused in less than {} ms, p99", each.name, each.most_p99_ms),
      percentile(ours, 0.99) < each.most_p99_ms);
}

Result<void> report_rate(Report& report, const CostCase& each) {
  const auto cell = start_cell(static_cast<int>(each.sensors), static_cast<int>(each.persons));
  if (!cell) return pass(cell);
  const double before = cell->fusion.front().cpu_seconds();
  const auto seen = watch(*cell, kLiveRun);
  if (!seen) return pass(seen);
  const double used = cell->fusion.front().cpu_seconds() - before;
  report.row(each.name, "fusion_cores", used / kLiveRun, "cores");
  report.row(each.name, "output_hz", seen->output_hz, "Hz", "configured",
             seen->output_hz / kCostRate);
  report.row(each.name, "lost_frames", static_cast<double>(seen->lost), "frames");
  return {};
}

}  // namespace

std::vector<std::string> cost_cases() {
  std::vector<std::string> names;
  for (const CostCase& each : kCostCases) names.emplace_back(each.name);
  return names;
}

Result<void> measure_cost(Report& report) {
  for (const CostCase& each : kCostCases) {
    if (!report.only().empty() && report.only() != each.name) continue;
    report_times(report, each);
    if (report.quick()) continue;
    if (auto done = report_rate(report, each); !done) return done;
  }
  report.note(
      "cost, scale: fuse_*_ms is the processor time of one instant from frames to snapshot, the "
      "least of three runs, beside the same with a plain mean; output_hz and fusion_cores are a "
      "real "
      "server's, whose sensors run in this process on the same cores.");
  return {};
}

}  // namespace chorus::bench

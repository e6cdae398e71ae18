#include "tests/bench/accuracy/fusion_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/performance.h"
#include "common/synthetic/performer.h"
#include "tests/bench/accuracy/fusion_cases.h"
#include "tests/bench/accuracy/fusion_report.h"
#include "tests/bench/methods/over_draws.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

constexpr Duration kTakeLength = std::chrono::seconds(12);
constexpr std::size_t kDrawsOfTake = 4;
constexpr std::uint64_t kDrawTake = 781;
constexpr double kPerformersSpread = 0.08;  // the same as for people who walk
constexpr std::size_t kWorst = 6;           // joints that are named
constexpr const char* kMean = "flip-fixed-mean-true-labels";

struct CapturedTake {
  std::string name;
  std::shared_ptr<const synthetic::Performance> performance;
};

fs::path folder_of_takes() {
  const char* given = std::getenv("CHORUS_MOTIONS");
  return given != nullptr ? fs::path(given) : fs::path();
}

std::vector<CapturedTake> takes_in(const fs::path& folder, Report& report) {
  std::set<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path kind = entry.path().extension();
    if (kind == ".bvh" || kind == ".amc" || kind == ".c3d" || kind == ".mvnx")
      files.insert(entry.path());
  }
  std::vector<CapturedTake> takes;
  for (const fs::path& file : files) {
    auto performance = synthetic::read_performance({file});
    if (!performance) {
      report.note(fmt::format("left out: {}: {}", file.filename().string(),
                              to_string(performance.error())));
      continue;
    }
    takes.push_back({file.filename().string(),
                     std::make_shared<const synthetic::Performance>(*std::move(performance))});
  }
  return takes;
}

/// The take as it is played in this draw: once, and forwards, because nobody runs backwards.  Of a
/// longer take another part is shown in each draw; after a shorter one the person keeps still.
synthetic::Person performer_of(const CapturedTake& take, std::uint64_t seed) {
  synthetic::Draw draw{seed, kDrawTake};
  synthetic::PerformerScript script;
  script.turn = draw.uniform(-std::numbers::pi, std::numbers::pi);
  script.body_scale += draw.uniform(-kPerformersSpread, kPerformersSpread);
  const synthetic::Performer performer(take.performance, script);
  const Duration length = performer.loop() / 2;  // played back and forth
  const double part = draw.uniform();
  const Duration longer = std::max(Duration{0}, length - kTakeLength);
  const Duration begin = begin_of(seed).time_since_epoch() - from_seconds(part * seconds(longer));
  return [=](Duration since_epoch) {
    return performer.at(std::clamp(since_epoch - begin, Duration{0}, length));
  };
}

/// Ours, and what it is to be better than.
std::vector<Contender> motion_contenders() {
  std::vector<Contender> kept;
  for (Contender& each : all_contenders()) {
    const bool shown = each.name == kOurs || each.name == "best-skeleton" ||
                       each.name == "flip-fixed-mean" || each.name == "otto" ||
                       each.name.ends_with("-true-labels");
    if (shown) kept.push_back(std::move(each));
  }
  return kept;
}

struct MotionCase {
  std::string name;
  std::string profile;
  std::size_t sensors = 6;
};

std::vector<MotionCase> all_motion_cases() {
  std::vector<MotionCase> cases;
  for (const char* profile : {"A", "B", "D"}) {
    for (const std::size_t sensors : {6U, 3U, 2U})
      cases.push_back({fmt::format("motions-{}-{}", sensors, profile), profile, sensors});
  }
  return cases;
}

/// The figures that tell most of one take.
bool is_telling(const Metric& metric) {
  return is_short_metric(metric) || metric.name == "jumps_per_minute" ||
         metric.name == "latency_ms" || metric.name == "nees" || metric.name == "ball95_percent";
}

void report_take(Report& report, const std::string& name, const Draws& draws) {
  for (std::size_t metric = 0; metric < metrics().size(); ++metric) {
    const Metric& shown = metrics()[metric];
    if (!is_telling(shown)) continue;
    const Comparison found = compare(name, draws, metric);
    if (shown.kind == Kind::Stated) {
      const Spread spread = found.spread_of(kOurs);
      report.row({name, shown.name, spread.median, shown.unit, kOurs, kNoRatio, spread});
    } else {
      found.report(report);
    }
  }
}

/// Draws' errors of a joint and its mirror image [m].
double joint_error(const Scored& scored, JointId joint) {
  return 0.5 * (scored.joints[index_of(joint)] + scored.joints[index_of(mirror(joint))]);
}

void report_worst_joints(Report& report, const std::string& name, const Draws& draws) {
  std::vector<std::pair<double, Comparison>> joints;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto joint = static_cast<JointId>(j);
    if (index_of(mirror(joint)) < j) continue;
    Comparison found(name, fmt::format("worst_{}_mm", name_of(joint)), "mm");
    for (std::size_t draw = 0; draw < draws.size(); ++draw) {
      for (const Scored& scored : draws[draw]) {
        if (scored.method == kOurs || scored.method == kMean)
          found.add(scored.method, draw, to_mm(joint_error(scored, joint)));
      }
    }
    joints.emplace_back(found.spread_of(kOurs).median, std::move(found));
  }
  std::ranges::stable_sort(joints, [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < std::min(kWorst, joints.size()); ++i) joints[i].second.report(report);
}

void measure_takes(Report& report, const MotionCase& each, const std::vector<CapturedTake>& takes) {
  const std::vector<Contender> contenders = motion_contenders();
  const std::size_t per_take = report.quick() ? 1 : kDrawsOfTake;
  const Draws draws = over_draws(per_take * takes.size(), [&](std::size_t draw) {
    Contest one = contest_of(each.profile, each.sensors, synthetic::PathKind::Stand);
    one.setting.seed = report.seed() + draw;
    one.setting.length = kTakeLength;
    one.setting.people = {performer_of(takes[draw % takes.size()], one.setting.seed)};
    one.every_method = false;
    return hold(one, contenders);
  });
  for (std::size_t take = 0; take < takes.size(); ++take) {
    Draws own;
    for (std::size_t i = take; i < draws.size(); i += takes.size()) own.push_back(draws[i]);
    report_take(report, each.name + ":" + takes[take].name, own);
  }
  report_worst_joints(report, each.name, draws);
  report_draws(report, each.name, draws, true);
}

}  // namespace

std::vector<std::string> motion_cases() {
  std::vector<std::string> names;
  for (MotionCase& each : all_motion_cases()) names.push_back(std::move(each.name));
  return names;
}

void measure_motions(Report& report, const std::string& name) {
  const fs::path folder = folder_of_takes();
  const std::vector<CapturedTake> takes =
      fs::is_directory(folder) ? takes_in(folder, report) : std::vector<CapturedTake>{};
  if (takes.empty()) {
    report.note(fmt::format("left out: {}: CHORUS_MOTIONS names no folder of takes", name));
    return;
  }
  for (const MotionCase& each : all_motion_cases()) {
    if (each.name == name) measure_takes(report, each, takes);
  }
  report.note(
      "motions: the errors of the simulated sensors were modelled on people who stand and walk; "
      "real trackers err more on people who lie, crawl or stand on their hands.  What counts is "
      "the ratio to the means of the same views.");
}

}  // namespace chorus::bench

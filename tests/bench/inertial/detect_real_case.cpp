// Errors injected into the optical orientations of real takes, and found by real sensors with a
// calibration estimated from the take's first part, a quarter of whose frames are wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/evaluation/judge.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/injected_errors.h"
#include "tests/bench/inertial/real_takes.h"

namespace chorus::bench {
namespace {

namespace ev = evaluation;
using inertial::LimbGroup;

constexpr double kLearnShare = 0.35;            // share of the take that calibrates
constexpr double kErrorLengths[] = {0.3, 1.5};  // of injected errors [s]

struct LimbGroupScore {
  ev::Counts frames, segments;
  std::vector<double> area, rate_area;
  double clean_alarms = 0.0, clean_minutes = 0.0, refused = 0.0, limbs = 0.0;
};

ev::ErrorTrack errors_after(const inertial::SensorCalibration& calibration,
                            const ev::OrientationPairs& pairs, double from) {
  ev::ErrorTrack out = ev::error_track(calibration, pairs);
  std::erase_if(out, [&](const auto& each) { return each.time < from; });
  return out;
}

void judge_sensor(const RealSensor& sensor, double length, std::mt19937_64& draw,
                  LimbGroupScore& score) {
  const ev::OrientationPairs clean = pairs_of(sensor);
  if (clean.size() < 100) return;
  score.limbs += 1.0;
  const double from = clean.front().time + kLearnShare * (clean.back().time - clean.front().time);
  const InjectedErrors bad = with_errors(clean, {from, length, ErrorAxis::Any}, draw);
  ev::OrientationPairs learn;
  for (const auto& pair : bad.pairs)
    if (pair.time < from) learn.push_back(pair);
  const auto fit = ev::fit_calibration(learn);
  if (!fit) return;
  score.refused += ev::calibrate_sensor(learn, "sensor", sensor.limb) ? 0.0 : 1.0;
  const ev::ErrorTrack errors = errors_after(fit->calibration, bad.pairs, from);
  std::vector<double> times;
  std::vector<ev::Timed<double>> angles;
  for (const auto& each : errors) {
    times.push_back(each.time);
    angles.push_back({each.time, each.value.angle});
  }
  const auto found = ev::detected_errors(errors);
  score.frames += ev::frame_counts(times, found, bad.truth);
  score.segments += ev::segment_counts(found, bad.truth);
  if (const auto area = ev::roc_area(angles, bad.truth)) score.area.push_back(*area);
  if (const auto area = ev::roc_area(rate_differences(bad.pairs, from), bad.truth))
    score.rate_area.push_back(*area);
  const ev::ErrorTrack untouched = errors_after(fit->calibration, clean, from);
  score.clean_alarms += static_cast<double>(ev::detected_errors(untouched).size());
  score.clean_minutes += (clean.back().time - from) / 60.0;
}

double mean_area(const std::vector<double>& all) {
  double sum = 0.0;
  for (const double each : all) sum += each;
  return all.empty() ? std::nan("") : sum / static_cast<double>(all.size());
}

void report_limbs(Report& report, const std::string& name, const LimbGroupScore& score) {
  const double none = std::nan("");
  report.row(name, "precision", score.frames.precision().value_or(none), "");
  report.row(name, "recall", score.frames.recall().value_or(none), "");
  report.row(name, "segment_precision", score.segments.precision().value_or(none), "");
  report.row(name, "segment_recall", score.segments.recall().value_or(none), "");
  report.row(name, "roc_area", mean_area(score.area), "", "angular-rate",
             mean_area(score.area) / mean_area(score.rate_area));
  report.row(name, "roc_area_angular_rate", mean_area(score.rate_area), "");
  report.row(name, "false_alarms_per_minute",
             score.clean_alarms / std::max(1e-9, score.clean_minutes), "1/min");
  report.row(name, "would_be_refused_percent", 100.0 * score.refused / std::max(1.0, score.limbs),
             "%");
}

}  // namespace

Result<void> run_detect_real(Report& report) {
  const auto takes = real_takes();
  if (!takes) return pass(takes);
  const int draws = report.quick() ? 3 : 20;
  for (const RealTake& take : *takes) {
    for (const double length : kErrorLengths) {
      std::array<LimbGroupScore, 3> scores;
      for (int draw = 0; draw < draws; ++draw) {
        std::mt19937_64 random(report.seed() + static_cast<std::uint64_t>(draw));
        for (const RealSensor& sensor : take.sensors)
          judge_sensor(sensor, length, random,
                       scores[static_cast<std::size_t>(group_of(sensor.limb))]);
      }
      for (const LimbGroup group : {LimbGroup::Trunk, LimbGroup::Arms, LimbGroup::Legs}) {
        const LimbGroupScore& score = scores[static_cast<std::size_t>(group)];
        const std::string name = "detect-real-" + take.name + (length < 1.0 ? "-0.3s-" : "-1.5s-") +
                                 std::string(name_of(group));
        if (score.limbs > 0) report_limbs(report, name, score);
      }
    }
  }
  report.note(
      "detect-real: errors of 55 to 150 degrees injected into optical orientations, one in three "
      "seconds; calibrated on the first 35 % with a quarter of its frames wrong; tau 45 degrees.");
  return {};
}

}  // namespace chorus::bench

// Errors injected into the optical orientations of real takes, and found by real sensors with a
// calibration estimated from the take's first part, a quarter of whose frames are wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/evaluation/judge.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/real_takes.h"

namespace chorus::bench {
namespace {

namespace ev = evaluation;
using inertial::LimbGroup;

constexpr double kLearnShare = 0.35;            // share of the take that calibrates
constexpr double kWrongShare = 0.25;            // of its instants, in bursts
constexpr double kErrorLengths[] = {0.3, 1.5};  // of injected errors [s]
constexpr double kErrorEvery = 3.0;             // one error in so many seconds
constexpr double kLeastErrorDeg = 55.0;         // [deg]: tau and ten more
constexpr double kMostErrorDeg = 150.0;

struct InjectedErrors {
  ev::OrientationPairs pairs;
  std::vector<ev::Segment> truth;
};

/// Turns the limb by an error about a random axis during [begin, end].
void turn_limb(ev::OrientationPairs& pairs, const ev::Segment& when,
               const Eigen::Quaterniond& off) {
  for (ev::OrientationPair& pair : pairs)
    if (pair.time >= when.begin && pair.time <= when.end)
      pair.tracked.world_from_limb = pair.tracked.world_from_limb * off;
}

Eigen::Quaterniond drawn_error(std::mt19937_64& draw) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(deg(kLeastErrorDeg), deg(kMostErrorDeg));
  const Eigen::Vector3d axis(normal(draw), normal(draw), normal(draw));
  return exp_map(angle(draw) * axis.normalized());
}

InjectedErrors with_errors(ev::OrientationPairs pairs, double from, double length,
                           std::mt19937_64& draw) {
  std::uniform_real_distribution<double> any;
  constexpr double kBurst = 0.5;
  for (double t = pairs.front().time; t < from; t += kBurst)
    if (any(draw) < kWrongShare) turn_limb(pairs, {t, t + kBurst - 1e-6}, drawn_error(draw));
  InjectedErrors out{std::move(pairs), {}};
  for (double t = from; t + kErrorEvery < out.pairs.back().time; t += kErrorEvery) {
    const double begin = t + any(draw) * (kErrorEvery - length - 0.5);
    out.truth.push_back({begin, begin + length});
    turn_limb(out.pairs, out.truth.back(), drawn_error(draw));
  }
  return out;
}

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

/// |difference of the angular rates| of tracker and sensor: the baseline of Fig. 9.
std::vector<ev::Timed<double>> rate_differences(const ev::OrientationPairs& pairs, double from) {
  ev::OrientationTrack tracked, sensed;
  for (const auto& pair : pairs) {
    tracked.push_back({pair.time, pair.tracked.world_from_limb});
    sensed.push_back({pair.time, pair.inertial_from_sensor});
  }
  const ev::Signal a = ev::angular_rates(tracked, 0.03);
  const ev::Signal b = ev::angular_rates(sensed, 0.03);
  std::vector<ev::Timed<double>> out;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (a[i].time >= from) out.push_back({a[i].time, std::abs(a[i].value - b[i].value)});
  return out;
}

void judge_sensor(const RealSensor& sensor, double length, std::mt19937_64& draw,
                  LimbGroupScore& score) {
  const ev::OrientationPairs clean = pairs_of(sensor);
  if (clean.size() < 100) return;
  score.limbs += 1.0;
  const double from = clean.front().time + kLearnShare * (clean.back().time - clean.front().time);
  const InjectedErrors bad = with_errors(clean, from, length, draw);
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

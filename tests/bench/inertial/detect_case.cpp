// Errors injected into a simulated tracker, and found by a simulated suit of 13 sensors; beside
// them what angular rate, acceleration and position show of the same errors (Fig. 9).
#include <array>
#include <cmath>

#include "common/evaluation/calibrate.h"
#include "common/evaluation/scores.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/injected_errors.h"
#include "tests/bench/inertial/simulated_take.h"

namespace chorus::bench {
namespace {

namespace ev = evaluation;
using inertial::LimbGroup;

constexpr double kDetectShare = 0.35;             // of the take that calibrates
constexpr double kAccelerationHalfWindow = 0.05;  // [s]
constexpr std::array kDetectLengths{0.3, 1.5};    // of errors [s]
constexpr std::array kDetectAxes{ErrorAxis::Bone, ErrorAxis::Across};

struct DetectScore {
  ev::Counts frames, segments;
  std::vector<double> orientation, rate, acceleration, position;  ///< areas under ROC
  double alarms = 0.0, minutes = 0.0;
};

double average_area(const std::vector<double>& all) {
  double sum = 0.0;
  for (const double each : all) sum += each;
  return all.empty() ? std::nan("") : sum / static_cast<double>(all.size());
}

void keep_area(const ev::Signal& values, const std::vector<ev::Segment>& truth,
               std::vector<double>& out) {
  if (const auto area = ev::roc_area(values, truth)) out.push_back(*area);
}

/// Where the tracker has the limb's end while it is turned: the bone's far end moves with it.
std::vector<ev::Timed<Eigen::Vector3d>> wrong_places(const SimulatedLimb& limb,
                                                     const ev::OrientationPairs& bad) {
  auto out = limb.places;
  const Eigen::Vector3d bone(0.0, limb.length, 0.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].value +=
        bad[i].tracked.world_from_limb * bone - limb.pairs[i].tracked.world_from_limb * bone;
  return out;
}

/// Baselines that know no orientation.
void score_baselines(const SimulatedLimb& limb, const InjectedErrors& bad, double from,
                     DetectScore& score) {
  keep_area(rate_differences(bad.pairs, from), bad.truth, score.rate);
  const auto places = wrong_places(limb, bad.pairs);
  keep_area(
      differences(ev::accelerations(places, kAccelerationHalfWindow), limb.acceleration, from),
      bad.truth, score.acceleration);
  ev::Signal off;  // what is measured where joints are compared with a perfect tracker's
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].time >= from)
      off.push_back({places[i].time, (places[i].value - limb.true_places[i]).norm()});
  keep_area(off, bad.truth, score.position);
}

void detect_on(const SimulatedLimb& limb, const ErrorPlan& plan, std::mt19937_64& draw,
               DetectScore& score) {
  const InjectedErrors bad = with_errors(limb.pairs, plan, draw);
  ev::OrientationPairs learn;
  for (const auto& pair : bad.pairs)
    if (pair.time < plan.from) learn.push_back(pair);
  const auto fit = ev::fit_calibration(learn);
  if (!fit) return;
  ev::ErrorTrack errors = ev::error_track(fit->calibration, bad.pairs);
  ev::ErrorTrack clean = ev::error_track(fit->calibration, limb.pairs);
  std::erase_if(errors, [&](const auto& each) { return each.time < plan.from; });
  std::erase_if(clean, [&](const auto& each) { return each.time < plan.from; });
  std::vector<double> times;
  ev::Signal angles;
  for (const auto& each : errors) {
    times.push_back(each.time);
    angles.push_back({each.time, each.value.angle});
  }
  const auto found = ev::detected_errors(errors);
  score.frames += ev::frame_counts(times, found, bad.truth);
  score.segments += ev::segment_counts(found, bad.truth);
  keep_area(angles, bad.truth, score.orientation);
  score_baselines(limb, bad, plan.from, score);
  score.alarms += static_cast<double>(ev::detected_errors(clean).size());
  score.minutes += (limb.pairs.back().time - plan.from) / 60.0;
}

void report_detection(Report& report, const std::string& name, const DetectScore& score) {
  const double none = std::nan("");
  const double ours = average_area(score.orientation);
  report.row(name, "precision", score.frames.precision().value_or(none), "");
  report.row(name, "recall", score.frames.recall().value_or(none), "");
  report.row(name, "segment_precision", score.segments.precision().value_or(none), "");
  report.row(name, "segment_recall", score.segments.recall().value_or(none), "");
  report.row(name, "roc_area", ours, "", "angular-rate", ours / average_area(score.rate));
  report.row(name, "roc_area_angular_rate", average_area(score.rate), "");
  report.row(name, "roc_area_acceleration", average_area(score.acceleration), "");
  report.row(name, "roc_area_position", average_area(score.position), "");
  report.row(name, "false_alarms_per_minute", score.alarms / std::max(1e-9, score.minutes),
             "1/min");
}

using DetectScores = std::array<std::array<std::array<DetectScore, 3>, 2>, 2>;

/// One person and all of their sensors, with every kind of error.
void detect_draw(std::uint64_t seed, double length, DetectScores& scores) {
  SimulatedTakePlan plan;
  plan.seed = seed;
  plan.length = length;
  const auto take = simulated_take(plan);
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (std::size_t size = 0; size < 2; ++size) {
      std::mt19937_64 random(seed * 8 + axis * 2 + size);
      const ErrorPlan errors{kDetectShare * length, kDetectLengths[size], kDetectAxes[axis]};
      for (const SimulatedLimb& limb : take)
        if (limb.pairs.size() > 100)
          detect_on(limb, errors, random,
                    scores[axis][size][static_cast<std::size_t>(group_of(limb.limb))]);
    }
}

}  // namespace

Result<void> run_detect(Report& report) {
  const int draws = report.quick() ? 2 : 20;
  DetectScores scores;
  for (int i = 0; i < draws; ++i)
    detect_draw(report.seed() + static_cast<std::uint64_t>(i), report.quick() ? 40.0 : 60.0,
                scores);
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (std::size_t size = 0; size < 2; ++size)
      for (const LimbGroup group : {LimbGroup::Trunk, LimbGroup::Arms, LimbGroup::Legs})
        report_detection(report,
                         std::string("detect-") + (axis == 0 ? "twist" : "swing") +
                             (size == 0 ? "-0.3s-" : "-1.5s-") + std::string(name_of(group)),
                         scores[axis][size][static_cast<std::size_t>(group)]);
  report.note(
      "detect: simulated; 13 sensors with noise of 2 degrees and the skin of real people, a "
      "tracker with "
      "5 degrees and 30 mm; errors of 55 to 150 degrees about the bone (twist) or across it "
      "(swing); "
      "calibrated on the first 35 % with a quarter of its frames wrong; tau 45 degrees.");
  return {};
}

}  // namespace chorus::bench

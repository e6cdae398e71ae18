// What `chorus characterise` finds of simulated sensors, beside what they err by in truth: jitter,
// angles of exchange, depth bias.
//
// A mannequin stands 2.5 m before one sensor, turns once in 24 s and back again.  Nothing here is
// tuned on these numbers, and the simulated sensors know nothing of the estimators.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/base/units.h"
#include "common/characteristics/characteristics.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/sensor_choice.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/report/report.h"
#include "tests/support/builders.h"

namespace chorus::bench {
namespace {

using namespace synthetic;
using characteristics::Characteristics;

constexpr Timestamp kBegin = from_unix_ns(1'795'000'000'000'000'000);
constexpr double kMark = 2.5;     // horizontal distance of the mannequin [m]
constexpr double kTurnTime = 24;  // of one turn [s]
constexpr double kPause = 4;      // before, between and after [s]
constexpr double kLength = 2 * kTurnTime + 3 * kPause;
constexpr double kPitch = deg(10);
constexpr std::array<const char*, 5> kProfiles{"gauss", "A", "B", "D", "C"};

/// The mannequin's front away from the sensor, counted on [rad].
double turned_at(double time) {
  const double full = 2 * std::numbers::pi;
  const double out = std::clamp((time - kPause) / kTurnTime, 0.0, 1.0);
  const double back = std::clamp((time - 2 * kPause - kTurnTime) / kTurnTime, 0.0, 1.0);
  return full * (out - back);
}

Scene scene_of_turn() {
  Scene scene;
  scene.epoch = kBegin;
  scene.people = {[](Duration since) {
    return testing::standing_person({0, 0, kMark}, deg(180) + turned_at(seconds(since)));
  }};
  scene.world_from_sensor = {stand_sensor({0, 1.6, 0}, 0.0, kPitch)};
  return scene;
}

/// What the sensor's errors are in truth.
struct Truth {
  characteristics::Noise jitter;
  std::vector<double> out, back;  ///< [rad]
  double bias = 0.0;              ///< Mean over tracked joints of the spine [m]
};

/// The errors alone: each joint where the mannequin's would be if it stood still at its first
/// place, so that the same measure applies.
std::vector<SensorFrame> errors_alone(const Scene& scene, std::vector<SensorFrame> frames) {
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor.front().inverse();
  const auto still = to_sensor(sensor_from_world, truth(scene, 0, kBegin));
  for (SensorFrame& frame : frames) {
    const auto exact = to_sensor(sensor_from_world, truth(scene, 0, frame.captured));
    for (BodyFrame& body : frame.bodies) {
      for (std::size_t j = 0; j < kJointCount; ++j)
        body.skeleton.joints[j].position += still.joints[j].position - exact.joints[j].position;
    }
  }
  return frames;
}

bool shown_exchanged(const Skeleton<SensorSpace>& body, const Skeleton<SensorSpace>& exact) {
  const auto span = [](const Skeleton<SensorSpace>& of) {
    return (of[JointId::ShoulderLeft].position - of[JointId::ShoulderRight].position).eval();
  };
  return span(body).dot(span(exact)) < 0;
}

Truth truth_of(const Scene& scene, const std::vector<SensorFrame>& frames) {
  Truth found;
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor.front().inverse();
  bool before = false;
  double count = 0;
  for (const SensorFrame& frame : frames) {
    if (frame.bodies.empty()) continue;
    const Skeleton<SensorSpace>& body = frame.bodies.front().skeleton;
    const auto exact = to_sensor(sensor_from_world, truth(scene, 0, frame.captured));
    const double away =
        characteristics::away_from_sensor(turned_at(seconds(frame.captured - kBegin)));
    if (body[JointId::ShoulderLeft].seen() && body[JointId::ShoulderRight].seen()) {
      const bool now = shown_exchanged(body, exact);
      if (now != before) (now ? found.out : found.back).push_back(away);
      before = now;
    }
    for (const JointId id :
         {JointId::SpineBase, JointId::SpineMid, JointId::SpineShoulder, JointId::Neck}) {
      if (body[id].state != JointState::Tracked) continue;
      found.bias += (exact[id].position - body[id].position).dot(exact[id].position.normalized());
      ++count;
    }
  }
  found.bias /= std::max(1.0, count);
  const auto alone = characteristics::characterise(errors_alone(scene, frames));
  if (alone) found.jitter = characteristics::noise_of(alone->jitter);
  return found;
}

struct Draw {
  Characteristics found;
  Truth truth;
};

Result<Draw> draw_of(const Scene& scene, const char* profile, std::uint64_t seed) {
  SensorChoice choice;
  choice.id = *SensorId::parse("s1");
  choice.profile = profile;
  choice.seed = choice.gauss.seed = seed;
  choice.own_clock = false;
  if (choice.profile != kGaussProfile) choice.draw = seed;
  const auto frames = record(scene, choice, kBegin, kBegin + from_seconds(kLength));
  if (!frames) return pass(frames);
  characteristics::Known known{characteristics::Mark{kMark, mm(10)}};
  if (choice.profile == "C")  // its shoulders never show the rear
    known.turns = {{kPause, kPause + kTurnTime},
                   {2 * kPause + kTurnTime, 2 * kPause + 2 * kTurnTime}};
  const auto found = characteristics::characterise(*frames, known);
  if (!found) return pass(found);
  return Draw{*found, truth_of(scene, *frames)};
}

using Value = double (*)(const Draw&);

double middle(const std::vector<double>& angles) {
  return angles.empty() ? std::nan("") : to_deg(median(angles));
}

struct Measure {
  const char* metric;
  const char* unit;
  Value found, truth;
};

const std::array<Measure, 6> kMeasures{{
    {"neck_jitter_along_mm", "mm",
     [](const Draw& d) { return to_mm(characteristics::noise_of(d.found.jitter).along); },
     [](const Draw& d) { return to_mm(d.truth.jitter.along); }},
    {"neck_jitter_across_mm", "mm",
     [](const Draw& d) { return to_mm(characteristics::noise_of(d.found.jitter).across); },
     [](const Draw& d) { return to_mm(d.truth.jitter.across); }},
    {"exchanged_at_deg", "deg", [](const Draw& d) { return middle(d.found.exchange.out); },
     [](const Draw& d) { return middle(d.truth.out); }},
    {"changed_back_at_deg", "deg", [](const Draw& d) { return middle(d.found.exchange.back); },
     [](const Draw& d) { return middle(d.truth.back); }},
    {"depth_bias_mm", "mm", [](const Draw& d) { return to_mm(d.found.depth_bias->mean.bias); },
     [](const Draw& d) { return to_mm(d.truth.bias); }},
    {"depth_bias_sigma_mm", "mm",
     [](const Draw& d) { return to_mm(d.found.depth_bias->mean.sigma); },
     [](const Draw& d) { return to_mm(std::abs(d.found.depth_bias->mean.bias - d.truth.bias)); }},
}};

double median_of(const std::vector<Draw>& draws, Value value) {
  std::vector<double> all;
  for (const Draw& each : draws) {
    if (std::isfinite(value(each))) all.push_back(value(each));
  }
  return all.empty() ? std::nan("") : median(std::move(all));
}

void add_rows(Report& report, const char* profile, const std::vector<Draw>& draws) {
  for (const Measure& each : kMeasures) {
    Row row;
    row.case_name = fmt::format("turn-{}", profile);
    row.metric = each.metric;
    row.value = median_of(draws, each.found);
    row.unit = each.unit;
    row.baseline = fmt::format("true {:.3g}", median_of(draws, each.truth));
    row.ratio = row.value / median_of(draws, each.truth);
    report.row(std::move(row));
  }
  const auto tells = std::ranges::count_if(draws, [](const Draw& each) {
    return each.found.exchange.front_rear == characteristics::FrontRear::Tells;
  });
  report.row(fmt::format("turn-{}", profile), "tells_front_from_rear_percent",
             100.0 * static_cast<double>(tells) / static_cast<double>(draws.size()), "%");
}

}  // namespace

Result<void> run_characterise(Report& report) {
  const Scene scene = scene_of_turn();
  for (const char* profile : kProfiles) {
    const bool rendered = std::string_view(profile) == "C";
    if (rendered && report.quick()) continue;
    const std::size_t count = report.quick() ? 2 : rendered ? 4 : 10;
    const auto results = over_draws(
        count, [&](std::size_t i) { return draw_of(scene, profile, report.seed() + i); });
    std::vector<Draw> draws;
    for (const auto& each : results) {
      if (!each) return pass(each);
      draws.push_back(*each);
    }
    add_rows(report, profile, draws);
  }
  report.note(
      "Medians over draws.  True: the same measure of the errors alone, the angles at which "
      "labels were exchanged, and the mean error along the line of sight.  Beside the stated "
      "sigma of the depth bias stands the error it had.");
  report.profile("gauss, A, B, D, C");
  return {};
}

}  // namespace chorus::bench

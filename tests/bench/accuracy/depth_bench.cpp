// Profile C compared with profiles A and B: how far one sensor's joints are from the truth when
// errors emerge from depth images, and when they are drawn at random.
//
// Both are reported with labels as given, and with labels corrected where left and right are
// swapped.
#include <algorithm>
#include <array>
#include <ctime>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/body/facing.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/sensor_choice.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/report/report.h"
#include "tests/judge/labelled_error.h"
#include "tests/judge/log_statistics.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using namespace synthetic;

constexpr Timestamp kBegin = from_unix_ns(1'795'000'000'000'000'000);
constexpr double kDistance = 2.6;  // from the sensor to the middle of the walk [m]

/// Names of the person's true orientations towards the sensor.
constexpr std::array<const char*, 3> kViews{"facing", "side", "rear"};

std::size_t view_of(double facing) {
  const double turned = std::abs(facing);
  return turned < deg(45) ? 0 : turned < deg(135) ? 1 : 2;
}

/// Sums over the frames of one view.
struct Tally {
  double given = 0;     ///< Sum of joint errors [m]
  double repaired = 0;  ///< Sum of joint errors with corrected labels [m]
  std::size_t joints = 0;
  std::size_t inferred = 0;
  std::size_t frames = 0;
  std::size_t seen = 0;
  std::size_t exchanged = 0;

  void add(const Skeleton<SensorSpace>& body, const Skeleton<SensorSpace>& exact);
};

void Tally::add(const Skeleton<SensorSpace>& body, const Skeleton<SensorSpace>& exact) {
  const LabelledError error = labelled_error(body, exact);
  for (const Joint& joint : body.joints) {
    joints += joint.seen() ? 1U : 0U;
    inferred += joint.state == JointState::Inferred ? 1U : 0U;
  }
  given += error.as_given;
  repaired += std::min(error.as_given, error.exchanged);
  exchanged += error.exchanged < error.as_given ? 1U : 0U;
  ++seen;
}

struct Outcome {
  std::array<Tally, kViews.size()> views;
  LogStatistics log;
  std::size_t ids = 0;
};

/// One sensor in front of people who move about a point 2.6 m away.
Scene scene_of(std::vector<Person> people) {
  Scene scene;
  scene.people = std::move(people);
  scene.world_from_sensor = {stand_sensor({0, 1.2, 0}, 0.0, deg(5))};
  return scene;
}

/// Index of the person whose neck is nearest to the body's.
std::size_t nearest(const std::vector<Skeleton<SensorSpace>>& people,
                    const Skeleton<SensorSpace>& body) {
  const auto gap = [&](const Skeleton<SensorSpace>& person) {
    return (person[JointId::Neck].position - body[JointId::Neck].position).norm();
  };
  const auto found = std::ranges::min_element(people, {}, gap);
  return static_cast<std::size_t>(found - people.begin());
}

Outcome watched(const Scene& scene, const SensorChoice& choice, Duration length) {
  Outcome outcome;
  std::set<std::uint64_t> ids;
  const auto frames = record(scene, choice, kBegin, kBegin + length).value();
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor[0].inverse();
  for (const SensorFrame& frame : frames) {
    std::vector<Skeleton<SensorSpace>> people;
    std::vector<Tally*> tallies;
    for (std::size_t person = 0; person < scene.people.size(); ++person) {
      people.push_back(to_sensor(sensor_from_world, truth(scene, person, frame.captured)));
      tallies.push_back(&outcome.views[view_of(facing_angle(people.back()).value_or(0.0))]);
      ++tallies.back()->frames;
    }
    for (const BodyFrame& body : frame.bodies) {
      const std::size_t person = nearest(people, body.skeleton);
      tallies[person]->add(body.skeleton, people[person]);
      ids.insert(body.id.value);
    }
  }
  outcome.ids = ids.size();
  outcome.log = statistics_of(frames);
  return outcome;
}

SensorChoice choice_of(std::string profile, std::uint64_t seed) {
  SensorChoice choice;
  choice.id = *SensorId::parse("s1");
  choice.profile = std::move(profile);
  choice.draw = seed;
  choice.seed = seed;
  choice.bias_seed = seed;
  choice.own_clock = false;
  return choice;
}

std::vector<Person> walkers(PathKind path, std::uint64_t seed, std::size_t count = 1) {
  constexpr std::uint64_t kPurpose = 1601;
  WalkerScript script;
  script.path = path;
  script.seed = seed;
  script.centre = {0.0, kDistance};
  script.reach = 0.9;
  script.body_scale = Draw{kPurpose, seed}.uniform(0.92, 1.1);
  return make_people(script, count);
}

/// Somebody who stands still, turned by `yaw` from facing the sensor.
Person standing(std::uint64_t seed, double yaw) {
  const Walker still([&] {
    WalkerScript script;
    script.seed = seed;
    script.path = PathKind::Stand;
    return script;
  }());
  const double heading = still.path().at(Duration::zero()).heading;
  const Eigen::Quaterniond turn = about_y(std::numbers::pi + yaw - heading);
  return [still, turn](Duration since_epoch) {
    auto body = still.at(since_epoch);
    for (Joint& joint : body.joints) {
      joint.position = Eigen::Vector3d(0, 0, kDistance) + turn * joint.position;
    }
    return body;
  };
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::nan("") : static_cast<double>(part) / static_cast<double>(whole);
}

/// Reports the median and the 5-95 % range over the draws that contain the view.
void spread(Report& report, const std::string& name, const std::string& metric,
            std::vector<double> values, const char* unit) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return;
  Row row{name, metric, median(values), unit, "", kNoRatio};
  row.spread = {row.value, percentile(values, 0.05), percentile(values, 0.95), 0, values.size()};
  report.row(std::move(row));
}

template <class Value>
std::vector<double> each(const std::vector<Outcome>& outcomes, Value value) {
  std::vector<double> values;
  for (const Outcome& outcome : outcomes) values.push_back(value(outcome));
  return values;
}

void show(Report& report, const std::string& name, const std::vector<Outcome>& outcomes) {
  for (std::size_t view = 0; view < kViews.size(); ++view) {
    const std::string at = name + "-" + kViews[view];
    const auto tally = [&](auto value) {
      return each(outcomes, [&](const Outcome& outcome) { return value(outcome.views[view]); });
    };
    const auto per_joint = [](double sum, const Tally& t) {
      return t.joints == 0 ? std::nan("") : to_mm(sum / static_cast<double>(t.joints));
    };
    spread(report, at, "mpjpe_given_mm",
           tally([&](const Tally& t) { return per_joint(t.given, t); }), "mm");
    spread(report, at, "mpjpe_repaired_mm",
           tally([&](const Tally& t) { return per_joint(t.repaired, t); }), "mm");
    spread(report, at, "labels_exchanged",
           tally([](const Tally& t) { return 100 * share(t.exchanged, t.seen); }), "%");
    spread(report, at, "inferred",
           tally([](const Tally& t) { return 100 * share(t.inferred, t.joints); }), "%");
    spread(report, at, "body_seen",
           tally([](const Tally& t) { return 100 * share(t.seen, t.frames); }), "%");
  }
  spread(report, name, "ids",
         each(outcomes, [](const Outcome& o) { return static_cast<double>(o.ids); }), "");
}

/// Compares with statistics of real logs; no parameter of profile C was fitted to these.
void show_log(Report& report, const std::string& name, const std::vector<Outcome>& outcomes) {
  using enum JointId;
  const auto bone = [&](JointId child) {
    return each(outcomes, [child](const Outcome& o) { return to_mm(o.log.bone_std.at(child)); });
  };
  spread(report, name, "white_neck_z_mm",
         each(outcomes, [](const Outcome& o) { return to_mm(o.log.white[index_of(Neck)].z()); }),
         "mm");
  spread(report, name, "bone_std_thigh_mm", bone(KneeLeft), "mm");
  spread(report, name, "bone_std_upper_arm_mm", bone(ElbowLeft), "mm");
  spread(report, name, "lag_third_s_shoulder",
         each(outcomes, [](const Outcome& o) { return o.log.lag_third.at(ShoulderLeft); }), "");
}

struct Walks {
  std::string profile;
  PathKind path = PathKind::Random;
  std::size_t people = 1;
  std::size_t draws = 20;
};

std::vector<Outcome> watched(const Report& report, const Walks& walks) {
  const Duration length = std::chrono::seconds(report.quick() ? 8 : 30);
  return over_draws(report.quick() ? 3 : walks.draws, [&](std::size_t i) {
    const std::uint64_t seed = report.seed() + i;
    return watched(scene_of(walkers(walks.path, seed, walks.people)),
                   choice_of(walks.profile, seed), length);
  });
}

std::vector<Outcome> stands(const Report& report, double yaw) {
  return over_draws(report.quick() ? 2 : 20, [&](std::size_t i) {
    const std::uint64_t seed = report.seed() + i;
    return watched(scene_of({standing(seed, yaw)}), choice_of("C", seed), std::chrono::seconds(6));
  });
}

void measure_speed(Report& report) {
  const Scene scene = scene_of(walkers(PathKind::Random, report.seed()));
  const double length = report.quick() ? 5.0 : 20.0;
  const std::clock_t before = std::clock();
  (void)record(scene, choice_of("C", report.seed()), kBegin, kBegin + from_seconds(length));
  const double spent = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  report.row("one-sensor-C", "times_real_time", length / spent, "");
  // Quick runs also happen in builds without optimisation, which are about ten times slower.
  if (!report.quick()) {
    report.condition(
        fmt::format("one sensor of profile C: {:.0f} times real time, at least 3", length / spent),
        length / spent >= 3);
  }
}

double facing_mm(const std::vector<Outcome>& outcomes) {
  return median(each(outcomes, [](const Outcome& o) {
    return to_mm(o.views[0].repaired /
                 static_cast<double>(std::max<std::size_t>(1, o.views[0].joints)));
  }));
}

}  // namespace

Result<void> run_depth(Report& report) {
  report.profile("C " + frozen_hash("C") + ", A " + frozen_hash("A"));
  std::vector<Outcome> emerged;
  for (const char* profile : {"A", "B", "C"}) {
    const auto outcomes = watched(report, {profile});
    show(report, std::string("walk-") + profile, outcomes);
    show_log(report, std::string("walk-") + profile, outcomes);
    if (profile[0] == 'C') emerged = outcomes;
  }
  show(report, "turn-C", watched(report, {"C", PathKind::Turn}));
  show(report, "assembly-C", watched(report, {"C", PathKind::Assembly}));
  show(report, "four-people-A", watched(report, {"A", PathKind::Random, 4, 5}));
  show(report, "four-people-C", watched(report, {"C", PathKind::Random, 4, 5}));
  for (const double yaw : {0.0, 45.0, 90.0, 135.0, 180.0}) {
    show(report, fmt::format("stand-{:.0f}-C", yaw), stands(report, deg(yaw)));
  }
  measure_speed(report);
  const double mpjpe = facing_mm(emerged);
  report.condition(fmt::format("walk-C-facing: {:.0f} mm, within 25-110 mm", mpjpe),
                   mpjpe >= 25 && mpjpe <= 110);
  report.note(
      "Simulated.  One sensor; joints against the truth at the true exposure.  Profile C: "
      "errors emerge from rendered depth images and a generic body fitter.");
  return {};
}

}  // namespace chorus::bench

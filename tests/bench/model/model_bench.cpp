// Is the simulated sensor like a real one?  Acceptance of profile A against published and measured
// figures: medians over several seeds, and the worst seed.
//
// This is the only place where the model may be tuned; its hash is printed with every other result.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/importers/datasets/labanotation_csv.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/model/mannequin.h"
#include "tests/bench/model/model_claims.h"
#include "tests/bench/model/model_plots.h"
#include "tests/bench/model/model_walks.h"
#include "tests/bench/model/table1.h"
#include "tests/bench/report/report.h"
#include "tests/judge/log_statistics.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using namespace synthetic;
using kinect::Profile;
using enum JointId;

constexpr auto kTurnedLog = std::chrono::seconds(32);  // 970 frames: as long as the real log
constexpr const char* kRealLog = "tests/data/kinect2_labanotation/Ges04_comehere.csv";

/// Returns each(seed) for several seeds.
template <class Each>
auto over_seeds(const Report& report, const Each& each) {
  return over_draws(report.quick() ? 3 : 7, [&](std::size_t i) { return each(report.seed() + i); });
}

/// The value farthest from the middle of the range.
double farthest(const std::vector<double>& values, Range range) {
  const double middle = 0.5 * (range.least + range.most);
  return *std::max_element(values.begin(), values.end(), [middle](double a, double b) {
    return std::abs(a - middle) < std::abs(b - middle);
  });
}

/// Reports the median and the worst value; the condition is on the median.
void check(Report& report, const Claim& claim, const std::vector<double>& values) {
  const double least = claim.range.least;
  const double most = claim.range.most;
  const double middle = 0.5 * (least + most);
  const double value = median(values);
  const std::string real = fmt::format("real {:.3g}-{:.3g}", least, most);
  report.row(claim.case_name, claim.metric, value, claim.unit, real, value / middle);
  const double far = farthest(values, claim.range);
  report.row(claim.case_name, fmt::format("{}_worst_seed", claim.metric), far, claim.unit, real,
             far / middle);
  if (report.quick() && claim.needs_long) return;
  const double top = std::min(claim.range.limit, most * (1 + claim.tolerance));
  report.condition(fmt::format("{} {}: {:.3g} within {:.0f} % of {:.3g}-{:.3g} {}", claim.case_name,
                               claim.metric, value, 100 * claim.tolerance, least, most, claim.unit),
                   value >= least * (1 - claim.tolerance) && value <= top);
}

/// A scene in which logs are recorded, and the length of each.
struct LogKind {
  Scene (*scene)(std::uint64_t seed);
  Duration length;
};

/// (a) Compares statistics of logs of several seeds, all of the same length, with those of real
/// logs.
void compare_with_logs(Report& report, std::span<const LogClaim> claims, const LogKind& kind) {
  const std::vector<LogStatistics> logs = over_seeds(report, [&](std::uint64_t seed) {
    return statistics_of(log_of(kind.scene(seed), seed, kind.length));
  });
  for (const LogClaim& each : claims) {
    std::vector<double> values;
    for (const LogStatistics& log : logs) values.push_back(each.of(log));
    check(report, each.claim, values);
  }
}

/// Compares the simulated field of view with that of a real depth camera, which was computed from
/// real joints and their pixels.
void compare_view(Report& report) {
  const kinect::ViewLimits view = kinect::nominal_profile("A").view;
  check(report, {"log-view", "width_deg", "deg", {69.9, 69.9}, 0.01},
        {to_deg(2 * view.half_width)});
  check(report, {"log-view", "height_deg", "deg", {60.1, 60.1}, 0.01},
        {to_deg(2 * view.half_height)});
}

/// Reports the shipped real log for comparison.  Its person stands and gestures instead of walking,
/// so there are no conditions.
Result<void> show_real_log(Report& report) {
  const auto log = importers::read_labanotation_csv(kRealLog);
  if (!log) return tl::unexpected(log.error());
  const LogStatistics s = statistics_of(log->frames);
  report.row("real-gesture", "frames", static_cast<double>(s.frames), "");
  for (const JointId id : {Neck, SpineMid, WristLeft, KneeLeft}) {
    for (const int axis : {0, 2}) {
      report.row("real-gesture", fmt::format("{}_{}_white_mm", name_of(id), axis == 0 ? 'x' : 'z'),
                 to_mm(s.white[index_of(id)][axis]), "mm");
    }
    report.row("real-gesture", fmt::format("{}_inferred_percent", name_of(id)),
               100.0 * s.inferred_share[index_of(id)], "%");
  }
  for (const JointId child : {SpineMid, SpineShoulder, Head, ElbowLeft, WristLeft}) {
    report.row("real-gesture", fmt::format("bone_to_{}_std_mm", name_of(child)),
               to_mm(s.bone_std.at(child)), "mm");
  }
  return {};
}

/// Reports the seconds simulated per second of one core, for six sensors and one person.
void measure_speed(Report& report) {
  Scene scene;
  scene.people = make_people(WalkerScript{}, 1);
  scene.world_from_sensor = ring_places(Ring{});
  const double length = report.quick() ? 5.0 : 20.0;
  const std::clock_t before = std::clock();
  for (std::size_t i = 0; i < scene.world_from_sensor.size(); ++i) {
    (void)kinect::record(scene,
                         {*SensorId::parse("s1"), i, kinect::nominal_profile("A"), report.seed(),
                          report.seed(), true},
                         kSomeTime, kSomeTime + from_seconds(length));
  }
  const double spent = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  report.row("six-sensors", "times_real_time", length / spent, "");
  if (report.quick()) return;
  report.condition(fmt::format("six sensors: {:.0f} times real time, at least 100", length / spent),
                   length / spent >= 100);
}

/// The results of both experiments with the mannequin in one draw.
struct MannequinFigures {
  double head = 0, neck_front = 0, neck_rear = 0, base_side = 0;  ///< Jitter [mm]
  double flip = 0, back = 0;                                      ///< [deg]
  double neck_worst = 0, base_worst = 0;                          ///< At yaws beyond 60 deg [mm]
};

double worst_beyond_60(const std::vector<MannequinSample>& swing, JointId id) {
  double most = 0;
  for (const MannequinSample& each : swing) {
    if (each.angle < deg(60)) continue;
    most = std::max(most, (each.shown[id].position - each.exact[id].position).norm());
  }
  return to_mm(most);
}

MannequinFigures mannequin_figures(std::uint64_t seed) {
  const Profile profile = kinect::nominal_profile("A");
  const auto samples = turn_full(profile, seed);
  MannequinFigures figures;
  figures.head = to_mm(jitter(samples, Head, 0, deg(360)));
  figures.neck_front = to_mm(jitter(samples, Neck, 0, deg(35)));
  figures.neck_rear = to_mm(jitter(samples, Neck, deg(160), deg(200)));
  figures.base_side = to_mm(jitter(samples, SpineBase, deg(80), deg(100)));
  figures.flip = figures.back = std::nan("");
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double jump =
        std::abs(wrap_angle(shown_facing(samples[i].shown) - shown_facing(samples[i - 1].shown)));
    if (jump < deg(25)) continue;
    (samples[i].angle < deg(180) ? figures.flip : figures.back) = to_deg(samples[i].angle);
  }
  const auto swing = swing_85(profile, seed);
  figures.neck_worst = worst_beyond_60(swing, Neck);
  figures.base_worst = worst_beyond_60(swing, SpineBase);
  return figures;
}

/// (b) Compares the mannequin's figures with Otto Figs. 5-8.  Jitter may be 0.2 to 1.3 times
/// Otto's bound.
void compare_with_mannequin(Report& report) {
  const std::vector<MannequinFigures> all = over_seeds(report, mannequin_figures);
  const auto values_of = [&](double MannequinFigures::*figure) {
    std::vector<double> values;
    for (const MannequinFigures& each : all) values.push_back(each.*figure);
    return values;
  };
  const auto bounded = [&](const char* metric, double MannequinFigures::*figure, double bound) {
    // The upper end allows 30 %; the lower one ensures that the order of magnitude is right.
    check(report, {"mannequin-360", metric, "mm", {0.2 * bound / (1 - kTolerance), bound}},
          values_of(figure));
  };
  bounded("head_jitter_mm", &MannequinFigures::head, 0.072);
  bounded("neck_front_jitter_mm", &MannequinFigures::neck_front, 0.2);
  bounded("neck_rear_jitter_mm", &MannequinFigures::neck_rear, 0.5);
  bounded("spine_base_side_jitter_mm", &MannequinFigures::base_side, 4.1);
  check(report, {"mannequin-360", "flip_deg", "deg", {120, 140}, 0.0},
        values_of(&MannequinFigures::flip));
  check(report, {"mannequin-360", "flip_back_deg", "deg", {255, 325}, 0.0},
        values_of(&MannequinFigures::back));
  const double neck = median(values_of(&MannequinFigures::neck_worst));
  const double base = median(values_of(&MannequinFigures::base_worst));
  report.row("mannequin-85", "neck_worst_mm", neck, "mm", "otto: best of all", neck / base);
  report.row("mannequin-85", "spine_base_worst_mm", base, "mm", "otto: leaves the circle");
  report.condition(
      "mannequin-85: beyond 60 deg the neck follows the circle better than the spine base",
      neck < base);
}

struct Pair {
  double angle;  ///< [deg]
  double table1_mm;
};
constexpr Pair kTable1[] = {
    {0, 9.6}, {45, 16.0}, {90, 17.8}, {135, 26.6}, {180, 12.3}};  // Otto Table 1
constexpr std::uint64_t kSetUps = 11;  // a single one is uncertain by 20 %

/// (c) Repeats Table 1 with the paper's ICP: twenty walks of 10 s for each set-up.  The median
/// over the set-ups is checked.
std::vector<TableOneBar> compare_with_table1(Report& report) {
  std::vector<TableOneBar> bars;
  for (const Pair& pair : kTable1) {
    const std::vector<double> values = over_draws(kSetUps, [&](std::size_t i) {
      return to_mm(repeatability(kinect::nominal_profile("A"),
                                 {.angle = deg(pair.angle), .seed = report.seed() + i}));
    });
    const double middle = median(values);
    bars.push_back({pair.angle, percentile(values, 0), middle, worst(values), pair.table1_mm});
    const std::string name = fmt::format("table1-{:.0f}", pair.angle);
    const std::string otto = fmt::format("otto {}", pair.table1_mm);
    report.row(name, "icp_deviation_mm", middle, "mm", otto, middle / pair.table1_mm);
    report.row(name, "least_set_up_mm", bars.back().least, "mm", otto);
    report.row(name, "most_set_up_mm", bars.back().most, "mm", otto);
    report.condition(
        fmt::format("{}: ICP deviates {:.1f} mm, within 25 % of {}", name, middle, pair.table1_mm),
        std::abs(middle / pair.table1_mm - 1.0) <= 0.25);
  }
  return bars;
}

/// (d) The joint error of one sensor compared with the truth; swapped labels are swapped back
/// first.
double joint_error_mm(std::uint64_t seed) {
  const Scene scene = one_sensor_scene(seed + 7);
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor[0].inverse();
  double sum = 0;
  std::size_t count = 0;
  for (const SensorFrame& frame : log_of(scene, seed, std::chrono::seconds(60))) {
    if (frame.bodies.empty()) continue;
    const auto exact = to_sensor(sensor_from_world, truth(scene, 0, frame.captured));
    double plain = 0;
    double swapped = 0;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const Joint& joint = frame.bodies.front().skeleton.joints[i];
      if (!joint.seen()) continue;
      plain += (joint.position - exact.joints[i].position).norm();
      swapped += (joint.position - exact[mirror(static_cast<JointId>(i))].position).norm();
      ++count;
    }
    sum += std::min(plain, swapped);
  }
  return to_mm(sum / static_cast<double>(count));
}

void compare_with_single_sensor(Report& report) {
  check(report, {"single-sensor", "mpjpe_mm", "mm", {50, 100}, 0.0},
        over_seeds(report, joint_error_mm));
}

}  // namespace

Result<void> run_model(Report& report) {
  report.profile("A " + kinect::frozen_hash());
  compare_with_logs(report, walking_claims(),
                    {one_sensor_scene, std::chrono::seconds(report.quick() ? 60 : 240)});
  compare_with_logs(report, turned_claims(), {turned_scene, kTurnedLog});
  compare_view(report);
  if (const Result<void> shown = show_real_log(report); !shown) return shown;
  compare_with_mannequin(report);
  compare_with_single_sensor(report);
  measure_speed(report);
  std::vector<TableOneBar> bars;
  if (!report.quick()) bars = compare_with_table1(report);
  report.note("Profile A of the body-tracking sensor model, hash " + kinect::frozen_hash() +
              ".  Real: statistics of Kinect v2 logs and Otto et al.  Medians over " +
              (report.quick() ? "3" : "7") + " seeds.");
  return report.plots().empty() ? Result<void>{}
                                : draw_figures(report.plots(), report.seed(), bars);
}

}  // namespace chorus::bench
